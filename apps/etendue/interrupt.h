// Ctrl-C ends a command early and keeps what is done; a second one kills.
#pragma once

#include <atomic>

namespace etendue::app {

/// True from the first Ctrl-C on.
extern std::atomic<bool> stop_requested;

/// From here on; before, Ctrl-C kills at once, as there is nothing to keep.
void catch_interrupts();

}  // namespace etendue::app
