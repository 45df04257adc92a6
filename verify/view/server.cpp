#include "verify/view/server.h"

#include <httplib.h>
#include <sodium.h>

#include <atomic>
#include <charconv>
#include <thread>

#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"
#include "verify/view/tile_file.h"

namespace svdag {
namespace {

using Clock = std::chrono::steady_clock;
using httplib::Request;
using httplib::Response;

std::string random_token() {
  unsigned char bytes[16];
  randombytes_buf(bytes, sizeof bytes);
  char hex[2 * sizeof bytes + 1];
  return sodium_bin2hex(hex, sizeof hex, bytes, sizeof bytes);
}

// Whether a Host header names this machine; any port, because tunnels have their own.
bool is_this_machine(const std::string& host) {
  const std::string name = host.substr(0, host.rfind(':'));
  return name == "127.0.0.1" || name == "localhost" || name == "[::1]";
}

bool is_equal(const std::string& a, const std::string& b) {
  return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

// Knows how long no page has been open.
class OpenPages {
 public:
  void open() {
    ++count_;
    was_open_ = true;
  }
  void close() {
    last_ = Clock::now().time_since_epoch().count();
    --count_;
  }
  bool gone_for(std::chrono::seconds time) const {
    return was_open_ && count_ == 0 &&
           Clock::now().time_since_epoch() - Clock::duration(last_) >= time;
  }

 private:
  std::atomic<int> count_ = 0;
  std::atomic<bool> was_open_ = false;
  std::atomic<Clock::rep> last_ = 0;
};

class Site {
 public:
  Site(const DagFile& file, const TileCutter& cutter, const ServerConfig& config)
      : cutter_(cutter),
        root_("/" + config.token + "/"),
        scene_(scene_json(file, cutter, {config.up, 1, true})) {
    // A connection takes a thread, and a browser opens six for a page.
    server_.new_task_queue = [] { return new httplib::ThreadPool(64); };
    server_.set_payload_max_length(0);
    // The default, SO_REUSEPORT, would share the port with another process.
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.set_keep_alive_max_count(1000000);
    server_.set_keep_alive_timeout(1);  // seconds; the end waits for idle connections
    server_.set_tcp_nodelay(true);
    server_.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"Cache-Control", "private, no-cache"}});
    server_.set_pre_routing_handler(
        [this](const Request& request, Response& response) { return admit(request, &response); });
    // admit() has checked the token, so the path begins with it.
    server_.Get(".*", [this](const Request& request, Response& response) {
      answer(request, request.path.substr(root_.size()), &response);
    });
  }

  httplib::Server& server() { return server_; }
  const OpenPages& pages() const { return pages_; }
  void end() {
    ending_ = true;
    server_.stop();
  }

 private:
  httplib::Server::HandlerResponse admit(const Request& request, Response* response) const {
    const bool admitted = is_this_machine(request.get_header_value("Host")) &&
                          is_equal(request.path.substr(0, root_.size()), root_);
    if (admitted && (request.method == "GET" || request.method == "HEAD"))
      return httplib::Server::HandlerResponse::Unhandled;
    response->status = admitted ? 405 : 403;
    return httplib::Server::HandlerResponse::Handled;
  }

  void answer(const Request& request, const std::string& name, Response* response) {
    if (name == "alive") return keep_open(response);
    if (name == "scene.json") return send(request, scene_, "application/json", response);
    if (name.starts_with("tiles/")) return send_tile(request, name.substr(6), response);
    for (const PageFile& file : page_files()) {
      if (file.name == (name.empty() ? "index.html" : name))
        return send(request, std::string(file.text), std::string(file.type).c_str(), response);
    }
    response->status = 404;
  }

  void send_tile(const Request& request, const std::string& id, Response* response) const {
    uint64_t path = 0;
    const auto read = std::from_chars(id.data(), id.data() + id.size(), path);
    const bool is_number = read.ec == std::errc() && read.ptr == id.data() + id.size();
    const std::optional<DagTile> tile = is_number ? tile_of_path(cutter_, path) : std::nullopt;
    if (!tile) {
      response->status = 404;
      return;
    }
    send(request, encode_tile(*tile), "application/octet-stream", response);
  }

  // The tag is a hash of the text: what a browser has is sent again only if it differs.
  static void send(const Request& request, const std::string& text, const char* type,
                   Response* response) {
    const std::string tag = "\"" + to_hex(hash128(std::as_bytes(std::span(text)), 0)) + "\"";
    response->set_header("ETag", tag);
    if (request.get_header_value("If-None-Match") == tag)
      response->status = 304;
    else
      response->set_content(text, type);
  }

  // A page keeps this request open; a line every second finds out when it is closed.
  void keep_open(Response* response) {
    pages_.open();
    response->set_chunked_content_provider(
        "text/event-stream",
        [this](size_t, httplib::DataSink& sink) {
          for (int i = 0; i < 10 && !ending_; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
          return !ending_ && sink.write(":\n", 2);
        },
        [this](bool) { pages_.close(); });
  }

  const TileCutter& cutter_;
  const std::string root_, scene_;
  httplib::Server server_;
  OpenPages pages_;
  std::atomic<bool> ending_ = false;
};

}  // namespace

void serve(const DagFile& file, const TileCutter& cutter, const ServerConfig& config,
           const std::function<void(const std::string& url)>& ready) {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot start");
  ServerConfig known = config;
  if (known.token.empty()) known.token = random_token();
  Site site(file, cutter, known);
  const std::string host = "127.0.0.1";
  const int port = known.port == 0
                       ? site.server().bind_to_any_port(host)
                       : (site.server().bind_to_port(host, known.port) ? known.port : -1);
  if (port < 0)
    fail_usage(host + ":" + std::to_string(known.port) + ": cannot listen: the port is in use");
  std::thread listener([&] { site.server().listen_after_bind(); });
  const auto end = [&] {
    site.end();
    listener.join();
  };
  try {
    while (!site.server().is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ready("http://" + host + ":" + std::to_string(port) + "/" + known.token + "/");
    while (known.keep || !site.pages().gone_for(known.linger)) {
      check_interrupt();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  } catch (...) {
    end();
    throw;
  }
  end();
}

}  // namespace svdag
