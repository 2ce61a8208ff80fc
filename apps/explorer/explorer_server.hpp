// The explorer's server: one page, the answers of its models, and nothing else.
#pragma once

#include <functional>

#include "apps/explorer/exploration.hpp"

namespace undula::apps {

/// Serves 127.0.0.1:`port` (0: any free one) until SIGINT, SIGTERM or SIGHUP; `on_ready` gets the port once
/// requests are taken.
///
///   GET /, /explore.js, ...            the page, part of the program
///   GET /models                        Exploration::description
///   GET /curve?model=0&frequency=..&drive=..&heads=low:high:step[&tolerance=..]
///   GET /period?model=0&frequency=..&drive=..&head=..
///   GET /scene?model=0&frequency=..&drive=..&head=..      TOML
///
/// Other paths are 404, other methods 405, a Host that is not this one 403, a question that is none 400 with
/// the message. No file is read or written. Throws InputError where the port is taken.
void serve_explorer(const Exploration& exploration, int port, const std::function<void(int)>& on_ready);

} // namespace undula::apps
