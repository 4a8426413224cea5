#include "render/thread_limit.h"

#include <tbb/global_control.h>

namespace etendue {

struct ThreadLimit::Control {
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0)
    control_ = std::make_unique<Control>(
        Control{tbb::global_control(tbb::global_control::max_allowed_parallelism, std::size_t(threads))});
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace etendue
