// The explorer's server: one page, its model's answers, and nothing else.
#pragma once

#include <functional>

#include "apps/explorer/explored_model.hpp"

namespace undula::apps {

/// Serves 127.0.0.1:`port` (0: any free one) until SIGINT, SIGTERM or SIGHUP; `on_ready` gets the port once
/// requests are taken.
///
///   GET /, /explore.js, /explore.css   the page, part of the program
///   GET /model                         ExploredModel::description
///   GET /curve?frequency=..&drive=..&heads=low:high:step   ExploredModel::curve
///
/// Other paths are 404, other methods 405, a Host that is not this one 403, a question that is none 400 with
/// the message. No file is read or written. Throws InputError where the port is taken.
void serve_explorer(const ExploredModel& model, int port, const std::function<void(int)>& on_ready);

} // namespace undula::apps
