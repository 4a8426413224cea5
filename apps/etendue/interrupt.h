// Ctrl-C, SIGTERM and SIGHUP end a command early and keep what is done; one more may hurry it, the next
// kills.
#pragma once

#include "render/render.h"

namespace etendue::app {

/// `soon` from the first signal on, `now` from the second on.
extern StopRequest stop_request;

/// What the signals after the first do.
enum class LaterSignals { kill, hurry };

/// From here on; before, they kill at once, as there is nothing to keep. A SIGHUP that is ignored (nohup)
/// stays so. A pipe without a reader ends nothing any more.
void catch_signals(LaterSignals later);

}  // namespace etendue::app
