#include "course/submission.h"
#include "course_commands.h"
#include "course_page.h"
#include "folder_watch.h"
#include "interrupt.h"
#include "messages.h"
#include "run_options.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>

namespace etendue::app {

namespace {

struct WatchOptions {
  std::string folder, scene;
  int port = 7080, samples_per_pixel = 64;
  double seconds = 10;
  bool is_sanitized = false;
};

class Watch {
 public:
  explicit Watch(const WatchOptions& options)
      : options_(options),
        submission_(submission_in(options.folder)),
        saved_(submission_.folder),
        page_(std::uint16_t(options.port)),
        scene_(options.scene.empty() ? submission_.folder / "scenes/ex3/area_sampling.xml"
                                     : std::filesystem::path(options.scene)) {
    if (options.is_sanitized) environment_ = sanitizer_environment();
    fmt::print("the picture is at {}\nsave {} to see it anew; Ctrl-C ends\n", page_.address(),
               submission_.source().string());
    std::fflush(stdout);
  }

  void run() {
    while (!stop_request.soon) {
      saved_.forget_change();
      if (compile_it()) render_passes();
      while (!must_start_again()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

 private:
  bool must_start_again() { return stop_request.soon || saved_.has_change(); }

  /// To the terminal and to the page.
  void tell(const std::string& status, const std::string& messages, bool is_bad) {
    say("{}{}\n", messages, status);
    page_.show({status, messages, is_bad});
  }

  bool compile_it() {
    page_.show({"compiling ...", warnings_ = ""});
    const Compilation compilation =
        compile(submission_.source(), submission_.module(),
                options_.is_sanitized ? CompiledFor::sanitizer : CompiledFor::speed);
    if (!compilation.is_done)
      tell("light_integrator.cpp does not compile", compilation.messages, true);
    else if (!compilation.messages.empty())
      say("{}", compilation.messages);
    warnings_ = compilation.messages;
    return compilation.is_done;
  }

  /// Each takes four times the samples of that before.
  void render_passes() {
    double seconds = options_.seconds;
    for (int samples = 1; samples <= options_.samples_per_pixel; samples *= 4) {
      const std::filesystem::path picture = submission_.build_folder() / "picture.png";
      std::vector<std::string> words = environment_;
      words.insert(words.end(),
                   {std::filesystem::read_symlink("/proc/self/exe"), "render", scene_, "--plugin",
                    submission_.module(), "--spp", std::to_string(samples), "--quiet", "-o", picture});
      const SandboxLimits limits{.seconds = seconds,
                                 .memory_bytes = options_.is_sanitized ? 0 : memory_for_rendering(),
                                 .writable = {submission_.build_folder()}};
      const SandboxResult result = run_in_sandbox(words, limits, [this] { return must_start_again(); });
      if (result.is_cut_short) return;
      if (!result.is_done()) {
        const std::string why = explanation(result, limits);
        tell(why.empty() ? "the render has failed" : "your integrator: " + why, warnings_ + result.output,
             true);
        return;
      }
      std::ifstream file(picture, std::ios::binary);
      page_.show_picture({std::istreambuf_iterator<char>(file), {}});
      tell(fmt::format("{} sample{} a pixel, {:.1f} s", samples, samples == 1 ? "" : "s", result.seconds),
           warnings_ + result.output + explanation(result, limits), false);
      seconds = std::max(options_.seconds, 8 * result.seconds);
    }
  }

  const WatchOptions& options_;
  Submission submission_;
  FolderWatch saved_;
  CoursePage page_;
  std::filesystem::path scene_;
  std::vector<std::string> environment_;  ///< Words before the program.
  std::string warnings_;                  ///< Of the compiler.
};

int run(const WatchOptions& options) {
  catch_signals(LaterSignals::kill);
  Watch watch(options);
  watch.run();
  return done;
}

}  // namespace

void add_course_watch_command(CLI::App& course, int& exit_code) {
  CLI::App* command =
      course.add_subcommand("watch", "Compile and render whenever light_integrator.cpp is saved, to a page");
  const auto options = std::make_shared<WatchOptions>();
  command->add_option("DIR", options->folder, "Folder of etendue course new")->required();
  command->add_option("--scene", options->scene, "What to render [DIR/scenes/ex3/area_sampling.xml]");
  command->add_option("--spp", options->samples_per_pixel, "Render up to so many samples a pixel [64]")
      ->check(whole_number(1 << 20));
  command->add_option("--port", options->port, "Of the page; 0: any that is free [7080]")
      ->check(whole_number(65535));
  command
      ->add_option("--seconds", options->seconds,
                   "A render of one sample a pixel that takes longer is ended [10]")
      ->check(CLI::PositiveNumber);
  command->add_flag("--sanitize", options->is_sanitized,
                    "Find reads and writes out of bounds: several times slower");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace etendue::app
