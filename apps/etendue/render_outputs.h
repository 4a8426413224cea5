// The files that a render leaves.
#pragma once

#include "render_report.h"

#include <string>
#include <vector>

namespace etendue::app {

/// NAME.partial.ENDING: where an image goes that is not finished and must not take NAME.ENDING's place.
std::string partial_name(const std::string& output);

/// All names that a render with these options may write to.
std::vector<std::string> files_written(const RenderOptions& options);

/// Writes the images and the stats, and says on stderr what an interrupted render has saved, and where. An
/// image that is finished replaces the file of its name; an interrupted one with all its pixels goes there if
/// no file is there yet, else to its partial name, as one without all its pixels always does. \return false
/// where something could not be written: each failure is reported, the other files are written.
bool write_outputs(const Rendering& rendering);

}  // namespace etendue::app
