#include "interrupt.h"

#include <csignal>

namespace etendue::app {

std::atomic<bool> stop_requested{false};

namespace {

extern "C" void handle_interrupt(int signal_number) {
  stop_requested = true;
  std::signal(signal_number, SIG_DFL);
}

}  // namespace

void catch_interrupts() { std::signal(SIGINT, handle_interrupt); }

}  // namespace etendue::app
