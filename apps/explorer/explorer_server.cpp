#include "apps/explorer/explorer_server.hpp"

#include <httplib.h>
#include <sys/socket.h>

#include <charconv>
#include <cmath>
#include <csignal>
#include <ctime>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <thread>

#include "apps/explorer/page.hpp"
#include "rom/base/error.hpp"

namespace undula::apps {
namespace {

constexpr const char* address = "127.0.0.1";
constexpr std::size_t longest_parameter = 200, largest_body = 1024;
constexpr int seconds_of_patience = 5;

enum Status {
  ok = 200,
  bad_request = 400,
  forbidden = 403,
  not_found = 404,
  wrong_method = 405,
  failed = 500
};

void answer(httplib::Response& response, Status status, std::string_view text, const char* type) {
  response.status = status;
  response.set_content(std::string(text), type);
}

void refuse(httplib::Response& response, Status status, const std::string& message) {
  answer(response, status, nlohmann::json({{"error", message}}).dump(), "application/json");
}

/// The one value of a parameter.
std::string parameter(const httplib::Request& request, const char* name) {
  const auto count = request.get_param_value_count(name);
  const std::string value = count == 1 ? request.get_param_value(name) : "";
  if (value.empty() || value.size() > longest_parameter) {
    throw InputError(std::string("the question does not state one ") + name,
                     std::to_string(count) + " times, " + std::to_string(value.size()) + " characters",
                     "once, at most " + std::to_string(longest_parameter) + " characters", request.path);
  }
  return value;
}

double number(const httplib::Request& request, const char* name) {
  const std::string text = parameter(request, name);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw InputError(std::string(name) + " is no number", '"' + text + '"', "a finite number", request.path);
  }
  return value;
}

/// Pages of other sites could reach a server on this machine by a name of their own (DNS rebinding): their
/// requests carry that name.
bool is_of_this_server(const httplib::Request& request, int port) {
  const std::string host = request.get_header_value("Host"), at = ":" + std::to_string(port);
  return request.get_header_value_count("Host") == 1 && (host == address + at || host == "localhost" + at);
}

/// The number of a model in the list of the command line; 0 where the question does not say.
std::size_t model_of(const httplib::Request& request) {
  if (!request.has_param("model")) {
    return 0;
  }
  const std::string text = parameter(request, "model");
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw InputError("model is no number of a model", '"' + text + '"', "0, 1, ...", "model");
  }
  return value;
}

/// Answers by `work`, with refusals told in JSON.
template <class Work>
httplib::Server::Handler answered_by(const Work& work, const char* type) {
  return [work, type](const httplib::Request& request, httplib::Response& response) {
    try {
      answer(response, ok, work(request), type);
    } catch (const InputError& error) {
      refuse(response, bad_request, error.what());
    } catch (const std::exception& error) {
      refuse(response, failed, error.what());
    }
  };
}

void add_pages(httplib::Server& server, const Exploration& exploration) {
  for (const PageFile& file : explorer_page()) {
    server.Get(file.path, [file](const httplib::Request&, httplib::Response& response) {
      answer(response, ok, file.text, file.type);
    });
  }
  constexpr const char* json = "application/json";
  server.Get("/models",
             answered_by([&](const httplib::Request&) { return exploration.description(); }, json));
  server.Get("/curve", answered_by(
                           [&](const httplib::Request& request) {
                             const double frequency = number(request, "frequency"),
                                          drive = number(request, "drive");
                             const auto tolerance = request.has_param("tolerance")
                                                        ? std::optional(number(request, "tolerance"))
                                                        : std::nullopt;
                             return exploration.curve(model_of(request), frequency, drive,
                                                      parameter(request, "heads"), tolerance);
                           },
                           json));
  const auto at_one_head = [](const auto& work) {
    return [work](const httplib::Request& request) {
      const double frequency = number(request, "frequency"), drive = number(request, "drive");
      return work(model_of(request), frequency, drive, number(request, "head"));
    };
  };
  server.Get("/period",
             answered_by(at_one_head([&](std::size_t model, double frequency, double drive, double head) {
                           return exploration.period(model, frequency, drive, head);
                         }),
                         json));
  server.Get("/scene",
             answered_by(at_one_head([&](std::size_t model, double frequency, double drive, double head) {
                           return exploration.scene(model, frequency, drive, head);
                         }),
                         "application/toml; charset=utf-8"));
}

/// What holds for every answer.
void add_rules(httplib::Server& server, int port) {
  server.set_default_headers(
      {{"X-Content-Type-Options", "nosniff"},
       {"Cache-Control", "no-store"},
       {"Referrer-Policy", "no-referrer"},
       {"Cross-Origin-Resource-Policy", "same-origin"},
       {"Content-Security-Policy", "default-src 'self'; img-src 'self' data:; frame-ancestors 'none'"}});
  server.set_pre_routing_handler([port](const httplib::Request& request, httplib::Response& response) {
    if (!is_of_this_server(request, port)) {
      refuse(response, forbidden, "this server answers requests to itself alone");
      return httplib::Server::HandlerResponse::Handled;
    }
    if (request.method != "GET" && request.method != "HEAD") {
      response.set_header("Allow", "GET, HEAD");
      refuse(response, wrong_method, "nothing can be written here");
      return httplib::Server::HandlerResponse::Handled;
    }
    return httplib::Server::HandlerResponse::Unhandled;
  });
  server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
    if (response.body.empty()) {
      refuse(response, static_cast<Status>(response.status), "there is no such page");
    }
  });
  // One request per connection: what a refused one brings along is never read as another.
  server.set_keep_alive_max_count(1);
  server.set_payload_max_length(largest_body);
  server.set_read_timeout(seconds_of_patience);
  server.set_write_timeout(seconds_of_patience);
  server.new_task_queue = [] { return new httplib::ThreadPool(4); }; // owned by the server
}

} // namespace

void serve_explorer(const Exploration& exploration, int port, const std::function<void(int)>& on_ready) {
  httplib::Server server;
  // The library would share a port that another process serves.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  const int bound = port == 0                            ? server.bind_to_any_port(address)
                    : server.bind_to_port(address, port) ? port
                                                         : -1;
  if (bound <= 0) {
    throw InputError("the port cannot be served", std::to_string(port), "a free one, or 0 for any", "--port");
  }
  add_rules(server, bound);
  add_pages(server, exploration);

  // Signals are waited for by a thread of their own, which may stop the server; no other thread sees them.
  sigset_t stops, before;
  sigemptyset(&stops);
  for (const int kind : {SIGINT, SIGTERM, SIGHUP}) {
    sigaddset(&stops, kind);
  }
  pthread_sigmask(SIG_BLOCK, &stops, &before);
  std::jthread waiter([&](const std::stop_token& over) {
    const timespec while_waiting{0, 100'000'000};
    bool stopped = false;
    while (!over.stop_requested()) {
      stopped = stopped || sigtimedwait(&stops, nullptr, &while_waiting) > 0;
      if (stopped && server.is_running()) {
        server.stop();
        return;
      }
    }
  });
  on_ready(bound);
  const bool served = server.listen_after_bind();
  waiter.request_stop();
  waiter.join();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (!served) {
    throw NumericsError("the server ended", std::string(address) + ":" + std::to_string(bound),
                        "another port");
  }
}

} // namespace undula::apps
