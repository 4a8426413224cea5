#include "interrupt.h"

#include <array>
#include <csignal>
#include <ctime>

namespace etendue::app {

StopRequest stop_request;

namespace {

struct Caught {
  int number;
  bool is_caught;
};
std::array<Caught, 3> signals{{{SIGINT, false}, {SIGTERM, false}, {SIGHUP, false}}};
LaterSignals later_signals = LaterSignals::kill;
std::atomic<double> last_obeyed_s{-1};

double now_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

extern "C" void handle_signal(int) {
  // A terminal that is closed, or a batch system, may send the same wish twice.
  constexpr double same_wish_s = 0.2;
  const double now = now_s();
  if (stop_request.soon && now - last_obeyed_s < same_wish_s) return;
  last_obeyed_s = now;
  if (stop_request.soon.exchange(true)) stop_request.now = true;
  if (!stop_request.now && later_signals == LaterSignals::hurry) return;
  for (const Caught& signal : signals)
    if (signal.is_caught) std::signal(signal.number, SIG_DFL);
}

}  // namespace

void catch_signals(LaterSignals later) {
  later_signals = later;
  std::signal(SIGPIPE, SIG_IGN);  // Who read what was said has gone: no reason to lose what is done.
  for (Caught& signal : signals) {
    const auto before = std::signal(signal.number, handle_signal);
    signal.is_caught = !(signal.number == SIGHUP && before == SIG_IGN);
    if (!signal.is_caught) std::signal(signal.number, SIG_IGN);
  }
}

}  // namespace etendue::app
