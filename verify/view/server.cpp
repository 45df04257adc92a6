#include "verify/view/server.h"

#include <httplib.h>
#include <sodium.h>

#include <charconv>
#include <condition_variable>
#include <deque>
#include <thread>

#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"
#include "verify/view/connections.h"
#include "verify/view/request_head.h"
#include "verify/view/tile_colours.h"
#include "verify/view/tile_file.h"

namespace svdag {
namespace {

using Clock = std::chrono::steady_clock;
using httplib::Request;
using httplib::Response;

constexpr size_t kWorkers = 16;

std::string random_token() {
  unsigned char bytes[16];
  randombytes_buf(bytes, sizeof bytes);
  char hex[2 * sizeof bytes + 1];
  return sodium_bin2hex(hex, sizeof hex, bytes, sizeof bytes);
}

bool send_all(int socket, std::string_view text, int flags = 0) {
  while (!text.empty()) {
    const ssize_t sent = ::send(socket, text.data(), text.size(), MSG_NOSIGNAL | flags);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    text.remove_prefix(size_t(sent));
  }
  return true;
}

// A request that has been read, and the connection for its answer.
class AdmittedRequest : public httplib::Stream {
 public:
  AdmittedRequest(Socket connection, std::string received)
      : connection_(std::move(connection)), received_(std::move(received)) {}

  bool is_read() const { return at_ == received_.size(); }
  Socket take_connection() { return std::move(connection_); }

  bool is_readable() const override { return !is_read(); }
  bool is_writable() const override { return true; }
  ssize_t read(char* to, size_t size) override {
    const size_t copied = received_.copy(to, size, at_);
    at_ += copied;
    return ssize_t(copied);
  }
  ssize_t write(const char* text, size_t size) override {
    return send_all(connection_.get(), {text, size}) ? ssize_t(size) : -1;
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return connection_.get(); }

 private:
  Socket connection_;
  std::string received_;
  size_t at_ = 0;
};

// Threads that take requests from a queue. Their end drops the requests that are left.
class Workers {
 public:
  using Work = std::function<void(AdmittedRequest&)>;

  explicit Workers(Work work) : work_(std::move(work)) {
    try {
      while (threads_.size() < kWorkers)
        threads_.emplace_back([this](const std::stop_token& stop) { run(stop); });
    } catch (const std::system_error&) {  // out of threads: some are enough
      if (threads_.empty()) throw;
    }
  }
  void add(AdmittedRequest request) {
    {
      const std::lock_guard lock(mutex_);
      queue_.push_back(std::move(request));
    }
    arrived_.notify_one();
  }

 private:
  void run(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (arrived_.wait(lock, stop, [this] { return !queue_.empty(); }) &&
           !stop.stop_requested()) {
      AdmittedRequest request = std::move(queue_.front());
      queue_.pop_front();
      lock.unlock();
      try {
        work_(request);
      } catch (const std::exception&) {  // out of memory: the connection is closed
      }
      lock.lock();
    }
  }

  const Work work_;
  std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::deque<AdmittedRequest> queue_;
  std::vector<std::jthread> threads_;  // last: they use the others
};

// The library parses requests and writes answers. It listens by svr_sock_, but Connections accepts
// and reads.
class Site : httplib::Server {
 public:
  Site(const DagFile& file, const TileCutter& cutter, const DagColours* colours,
       const ServerConfig& config)
      : cutter_(cutter),
        colours_(colours),
        root_("/" + config.token + "/"),
        scene_(
            scene_json(file, cutter, {config.up, 1, true, colours ? colours->view().level() : 0})) {
    set_payload_max_length(0);
    set_keep_alive_max_count(1000000);
    set_keep_alive_timeout(Connections::kHeadTime.count());
    // The default, SO_REUSEPORT, would share the port with another process.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    set_default_headers({{"Content-Security-Policy", "frame-ancestors 'none'"},
                         {"X-Content-Type-Options", "nosniff"},
                         {"Referrer-Policy", "no-referrer"},
                         {"Cross-Origin-Resource-Policy", "same-origin"},
                         {"Cache-Control", "private, no-cache"}});
    // admission_status() has checked the token, so the path begins with it.
    Get(".*", [this](const Request& request, Response& response) {
      answer(request, request.path.substr(root_.size()), &response);
    });
  }
  ~Site() override {
    if (svr_sock_ != INVALID_SOCKET) ::close(svr_sock_);
  }

  // Returns the port, or -1 if it is in use.
  int listen_at(const std::string& host, int port) {
    if (port == 0) return bind_to_any_port(host);
    return bind_to_port(host, port) ? port : -1;
  }

  // Serves until `is_done`, which is called every 50 ms with the number of open pages.
  void serve(const std::function<bool(size_t)>& is_done) {
    Connections connections(svr_sock_);
    Workers workers([&](AdmittedRequest& request) {
      bool is_closed = false;
      if (process_request(request, false, is_closed, nullptr) && !is_closed && request.is_read())
        connections.put_back(request.take_connection());
    });
    while (!is_done(connections.held())) {
      connections.wait(std::chrono::milliseconds(50), [&](Socket connection, std::string received) {
        admit(std::move(connection), std::move(received), &connections, &workers);
      });
    }
  }

 private:
  void admit(Socket connection, std::string received, Connections* connections, Workers* workers) {
    const size_t end =
        std::string_view(received).substr(0, Connections::kMaxHeadBytes).find(kEndOfHead);
    const std::string_view head = std::string_view(received).substr(0, end + kEndOfHead.size());
    const int status = end == received.npos ? 431 : admission_status(head, root_);
    if (status != 200) {
      send_all(connection.get(), head_of_answer(status) + "Content-Length: 0\r\n\r\n",
               MSG_DONTWAIT);
    } else if (requested_name(head, root_) == "alive") {
      // A page keeps this request open while it is shown.
      if (send_all(connection.get(),
                   head_of_answer(200) + "Content-Type: text/event-stream\r\n\r\n", MSG_DONTWAIT))
        connections->hold(std::move(connection));
    } else {
      workers->add({std::move(connection), std::move(received)});
    }
  }

  static std::string head_of_answer(int status) {
    return "HTTP/1.1 " + std::to_string(status) + " \r\nConnection: close\r\n";
  }

  void answer(const Request& request, const std::string& name, Response* response) const {
    if (name == "scene.json") return send(request, scene_, "application/json", response);
    if (name.starts_with("tiles/"))
      return send_words(request, tile_words(name.substr(6)), response);
    if (name.starts_with("colours/"))
      return send_words(request, colour_words(name.substr(8)), response);
    for (const PageFile& file : page_files()) {
      if (file.name == (name.empty() ? "index.html" : name))
        return send(request, std::string(file.text), std::string(file.type).c_str(), response);
    }
    response->status = 404;
  }

  using Words = std::optional<std::vector<uint32_t>>;

  static std::optional<uint64_t> number_of(std::string_view text) {
    uint64_t number = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return {};
    return number;
  }
  Words tile_words(std::string_view id) const {
    const auto path = number_of(id);
    const auto tile = path ? tile_of_path(cutter_, *path) : std::nullopt;
    return tile ? Words(words_of(*tile)) : std::nullopt;
  }
  // "PATH/LEVEL".
  Words colour_words(std::string_view name) const {
    const size_t slash = std::min(name.find('/'), name.size() - 1);
    const auto path = number_of(name.substr(0, slash)), level = number_of(name.substr(slash + 1));
    if (!colours_ || !path || !level || *level > cutter_.levels()) return {};
    return colours_of_tile(*colours_, *path, uint32_t(*level));
  }
  static void send_words(const Request& request, const Words& words, Response* response) {
    if (words)
      send(request, compressed(*words), "application/octet-stream", response);
    else
      response->status = 404;
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

  const TileCutter& cutter_;
  const DagColours* const colours_;
  const std::string root_, scene_;
};

}  // namespace

void serve(const DagFile& file, const TileCutter& cutter, const DagColours* colours,
           const ServerConfig& config, const std::function<void(const std::string& url)>& ready) {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot start");
  ServerConfig known = config;
  if (known.token.empty()) known.token = random_token();
  Site site(file, cutter, colours, known);
  const std::string host = "127.0.0.1";
  const int port = site.listen_at(host, known.port);
  if (port < 0)
    fail_usage(host + ":" + std::to_string(known.port) + ": cannot listen: the port is in use");
  ready("http://" + host + ":" + std::to_string(port) + "/" + known.token + "/");
  std::optional<Clock::time_point> last_open;
  site.serve([&](size_t open_pages) {
    check_interrupt();
    if (open_pages > 0) last_open = Clock::now();
    return !known.keep && last_open && Clock::now() - *last_open >= known.linger;
  });
}

}  // namespace svdag
