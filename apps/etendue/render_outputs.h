// The files that a render leaves.
#pragma once

#include "render_report.h"

#include <string>
#include <vector>

namespace etendue::app {

/// A file that was written: the name on the command line, and the one it has.
struct WrittenFile {
  std::string asked_for, name;
};

struct WrittenFiles {
  std::vector<WrittenFile> images, stats;
  bool are_all = true;  ///< False where one could not be written.
};

/// NAME.partial.ENDING: where a file goes that must not take NAME.ENDING's place, its image not being
/// finished.
std::string partial_name(const std::string& output);

/// All names that a render with these options may write to.
std::vector<std::string> files_written(const RenderOptions& options);

/// Writes the images and the stats. An image that is finished replaces the file of its name; an interrupted
/// one with all its pixels goes there if no file is there yet, else to its partial name, as one without all
/// its pixels always does; one without any is not written. The stats go to their partial name where an image
/// goes to its own. Each failure is said on stderr, and the other files are written.
WrittenFiles write_outputs(const Rendering& rendering);

/// On stderr: what an interrupted render has saved, where, and what of earlier renders is left beside it.
/// With --quiet only where a file is not where it was asked for.
void say_what_was_saved(const Rendering& rendering, const WrittenFiles& written);

}  // namespace etendue::app
