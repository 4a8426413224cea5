#include "course_page.h"

#include "base/error.h"

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <fmt/format.h>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string_view>
#include <sys/time.h>
#include <thread>

namespace etendue::app {

namespace {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;

/// Asks for the state until the program has gone.
constexpr std::string_view page = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>etendue course watch</title>
<style>
  body { font: 15px sans-serif; margin: 1.5em; background: #26262a; color: #ddd; }
  #status { font-weight: bold; margin-bottom: 1em; }
  #status.bad { color: #ff9c80; }
  img { max-width: 100%; background: #000; }
  img.old { opacity: 0.45; }
  pre { white-space: pre-wrap; background: #1a1a1d; padding: 1em; }
  pre:empty { display: none; }
</style>
<div id="status">...</div>
<pre id="messages"></pre>
<img id="picture" hidden alt="what your integrator renders">
<script>
  const at = id => document.getElementById(id);
  let seen = -1, picture = -1;
  async function look() {
    try {
      const state = await (await fetch("/state", {cache: "no-store"})).json();
      if (state.version !== seen) {
        seen = state.version;
        at("status").textContent = state.status;
        at("status").className = state.is_bad ? "bad" : "";
        at("messages").textContent = state.messages;
        at("picture").className = state.is_bad ? "old" : "";
      }
      if (state.picture > 0 && state.picture !== picture) {
        picture = state.picture;
        at("picture").src = "/picture.png?" + picture;
        at("picture").hidden = false;
      }
    } catch (error) {
      seen = -1;
      at("status").textContent = "etendue course watch has ended";
      at("status").className = "bad";
    }
    setTimeout(look, 150);
  }
  look();
</script>
</html>
)";

using Response = http::response<http::string_body>;

Response answer_of(http::status status, std::string_view type, std::string body) {
  Response response{status, 11};
  response.set(http::field::content_type, boost::beast::string_view(type.data(), type.size()));
  response.set(http::field::cache_control, "no-store");
  response.keep_alive(false);
  response.body() = std::move(body);
  response.prepare_payload();
  return response;
}

}  // namespace

struct CoursePage::Server {
  boost::asio::io_context context;
  tcp::acceptor acceptor{context};
  std::atomic<bool> must_end{false};
  std::mutex mutex;  ///< Of all that follows.
  PageContent content{"starting"};
  std::string png;
  int version = 0, picture = 0;
  std::thread thread;

  Response answer(std::string_view target) {
    const std::lock_guard lock(mutex);
    if (target == "/") return answer_of(http::status::ok, "text/html; charset=utf-8", std::string(page));
    if (target == "/state") {
      const nlohmann::json state{{"version", version},
                                 {"picture", picture},
                                 {"status", content.status},
                                 {"messages", content.messages},
                                 {"is_bad", content.is_bad}};
      constexpr auto broken_text = nlohmann::json::error_handler_t::replace;
      return answer_of(http::status::ok, "application/json", state.dump(-1, ' ', false, broken_text));
    }
    if (target.substr(0, 12) == "/picture.png" && !png.empty())
      return answer_of(http::status::ok, "image/png", png);
    return answer_of(http::status::not_found, "text/plain", "there is no such page\n");
  }

  /// One request, of a browser that may have gone.
  void serve(tcp::socket socket) {
    const timeval patience{1, 0};
    setsockopt(socket.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(socket.native_handle(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    boost::beast::flat_buffer buffer;
    http::request<http::empty_body> request;
    boost::system::error_code failed;
    http::read(socket, buffer, request, failed);
    if (failed) return;
    http::write(socket, answer({request.target().data(), request.target().size()}), failed);
    socket.shutdown(tcp::socket::shutdown_send, failed);
  }

  void run() {
    while (!must_end) {
      boost::system::error_code failed;
      tcp::socket socket(context);
      acceptor.accept(socket, failed);
      if (!failed && !must_end) serve(std::move(socket));
    }
  }
};

CoursePage::CoursePage(std::uint16_t port) : server_(std::make_unique<Server>()) {
  boost::system::error_code failed;
  const tcp::endpoint here(boost::asio::ip::address_v4::loopback(), port);
  server_->acceptor.open(here.protocol(), failed);
  if (!failed) server_->acceptor.set_option(tcp::acceptor::reuse_address(true), failed);
  if (!failed) server_->acceptor.bind(here, failed);
  if (!failed) server_->acceptor.listen(boost::asio::socket_base::max_listen_connections, failed);
  if (failed)
    throw InputError(
        fmt::format("cannot show a page at port {}: {}\n  take another with --port, or 0 for any", port,
                    failed.message()));
  server_->thread = std::thread([this] { server_->run(); });
}

CoursePage::~CoursePage() {
  server_->must_end = true;
  // Waking accept() takes a visitor.
  boost::system::error_code failed;
  tcp::socket visitor(server_->context);
  visitor.connect(server_->acceptor.local_endpoint(), failed);
  server_->thread.join();
}

std::string CoursePage::address() const {
  return fmt::format("http://localhost:{}/", server_->acceptor.local_endpoint().port());
}

void CoursePage::show(const PageContent& content) {
  const std::lock_guard lock(server_->mutex);
  server_->content = content;
  ++server_->version;
}

void CoursePage::show_picture(std::string png) {
  const std::lock_guard lock(server_->mutex);
  server_->png = std::move(png);
  ++server_->picture;
}

}  // namespace etendue::app
