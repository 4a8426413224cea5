// What the lab has rendered as one HTML file, with sliders.
#pragma once

#include "course/lab.h"

#include <string>

namespace etendue {

/// Complete, with all pictures in it. Throws InputError where the page's text is not there (course_files.h).
std::string lab_page(const LabGrid& grid, const Lab& lab);

}  // namespace etendue
