// Code that is loaded when it is first needed.
#pragma once

#include <string>

namespace etendue {

/// The function `entry` (extern "C") of libetendue_NAME.so, which lies beside this library; it stays loaded.
/// Throws InputError where there is none.
void* module_entry(const std::string& name, const char* entry);

}  // namespace etendue
