// A picture and what is to be said of it, as a page in a browser on this machine.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace etendue::app {

struct PageContent {
  std::string status;      ///< One line.
  std::string messages{};  ///< Of the compiler, of the program: as they are.
  bool is_bad = false;     ///< The status says that something is wrong.
};

class CoursePage {
 public:
  /// \param port 0: any that is free. Throws InputError where it is taken.
  explicit CoursePage(std::uint16_t port);
  ~CoursePage();
  CoursePage(const CoursePage&) = delete;
  CoursePage& operator=(const CoursePage&) = delete;

  std::string address() const;  ///< http://localhost:PORT/
  void show(const PageContent& content);
  void show_picture(std::string png);

 private:
  struct Server;
  std::unique_ptr<Server> server_;
};

}  // namespace etendue::app
