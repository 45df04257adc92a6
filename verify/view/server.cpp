#include "verify/view/server.h"

#include <fcntl.h>
#include <httplib.h>
#include <poll.h>
#include <sodium.h>
#include <sys/eventfd.h>

#include <atomic>
#include <charconv>
#include <mutex>
#include <thread>
#include <vector>

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
  const size_t bracket = host.starts_with('[') ? host.find(']') : 0;
  const size_t end = std::min(host.find(':', std::min(bracket, host.size())), host.size());
  const std::string name = host.substr(0, end), port = host.substr(end);
  const bool is_port = port.empty() || port.find_first_not_of("0123456789", 1) == port.npos;
  return is_port && (name == "127.0.0.1" || name == "localhost" || name == "[::1]");
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

// A connection whose next request has not arrived whole.
struct Connection {
  int socket;
  std::string head;  // what has arrived
  Clock::time_point deadline;
};

// A request that has arrived, for httplib. Its answer goes to the socket.
class RequestStream : public httplib::Stream {
 public:
  explicit RequestStream(Connection* connection) : connection_(*connection) {}
  ~RequestStream() override { connection_.head.erase(0, at_); }

  bool is_readable() const override { return at_ < connection_.head.size(); }
  bool is_writable() const override {
    constexpr int kWaitMs = 5000;
    pollfd ready{connection_.socket, POLLOUT, 0};
    return poll(&ready, 1, kWaitMs) == 1 && (ready.revents & (POLLERR | POLLHUP)) == 0;
  }
  ssize_t read(char* to, size_t size) override {
    const size_t n = connection_.head.copy(to, size, at_);
    at_ += n;
    return ssize_t(n);
  }
  ssize_t write(const char* from, size_t size) override {
    if (!is_writable()) return -1;
    return send(connection_.socket, from, size, MSG_NOSIGNAL);
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return connection_.socket; }

 private:
  Connection& connection_;
  size_t at_ = 0;
};

// An HTTP server whose worker threads see only whole requests with the token. One thread reads the
// heads of all connections; heads are bounded in bytes and time, so a stranger who sends much,
// slowly or often holds no worker and little memory.
class BoundedServer : public httplib::Server {
 public:
  // `root`: what the path of a request must begin with.
  explicit BoundedServer(std::string root) : root_(std::move(root)), pool_(64) {
    new_task_queue = [] { return new RunAtOnce; };
    reader_ = std::thread([this] { read_heads(); });
  }
  ~BoundedServer() override { end(); }

  // After stop(): ends all connections.
  void end() {
    if (!reader_.joinable()) return;
    ending_ = true;
    wake();
    reader_.join();
    pool_.shutdown();
    for (const Connection& each : incoming_) close(each.socket);
    incoming_.clear();
    close(wake_);
  }

 private:
  static constexpr size_t kMaxHead = size_t(1) << 14;
  static constexpr size_t kMaxConnections = 512;
  static constexpr std::chrono::seconds kHeadTime{5}, kIdleTime{30};

  struct RunAtOnce : httplib::TaskQueue {
    void enqueue(std::function<void()> task) override { task(); }
    void shutdown() override {}
  };

  // Called by httplib for each connection that it accepts.
  bool process_and_close_socket(socket_t socket) override {
    fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_NONBLOCK);
    add({socket, {}, Clock::now() + kHeadTime});
    return true;
  }
  void add(Connection connection) {
    const std::lock_guard lock(mutex_);
    incoming_.push_back(std::move(connection));
    wake();
  }
  void wake() { eventfd_write(wake_, 1); }

  void read_heads() {
    std::vector<Connection> waiting;
    while (!ending_) {
      {
        const std::lock_guard lock(mutex_);
        std::ranges::move(incoming_, std::back_inserter(waiting));
        incoming_.clear();
      }
      const size_t many = waiting.size() - std::min(waiting.size(), kMaxConnections);
      for (size_t i = 0; i < many; ++i) close(waiting[i].socket);
      waiting.erase(waiting.begin(), waiting.begin() + ptrdiff_t(many));
      std::vector<pollfd> ready{{wake_, POLLIN, 0}};
      for (const Connection& each : waiting) ready.push_back({each.socket, POLLIN, 0});
      constexpr int kTickMs = 250;
      poll(ready.data(), ready.size(), kTickMs);
      if (ready[0].revents != 0) {
        eventfd_t value;
        eventfd_read(wake_, &value);
      }
      std::vector<Connection> still;
      for (size_t i = 0; i < waiting.size(); ++i) {
        if (!is_settled(&waiting[i], ready[i + 1].revents != 0))
          still.push_back(std::move(waiting[i]));
      }
      waiting = std::move(still);
    }
    for (const Connection& each : waiting) close(each.socket);
  }

  // Whether the connection waits no longer: it was passed to a worker, or closed.
  bool is_settled(Connection* connection, bool readable) {
    std::string& head = connection->head;
    if (readable) {
      char bytes[4096];
      const ssize_t n = recv(connection->socket, bytes, sizeof bytes, 0);
      const bool again = n < 0 && (errno == EAGAIN || errno == EINTR);
      if (n <= 0 && !again) return refuse(*connection, nullptr);
      if (head.empty()) connection->deadline = Clock::now() + kHeadTime;
      if (n > 0) head.append(bytes, size_t(n));
    }
    if (head.find("\r\n\r\n") != head.npos) {
      const size_t path = head.find(' ') + 1;
      if (!is_equal(head.substr(path, root_.size()), root_))
        return refuse(*connection, "403 Forbidden");
      pool_.enqueue([this, it = *connection]() mutable { answer(std::move(it)); });
      return true;
    }
    if (head.size() > kMaxHead) return refuse(*connection, "431 Request Header Fields Too Large");
    return Clock::now() > connection->deadline && refuse(*connection, nullptr);
  }

  // Closes the connection, with a status if not null. Returns true.
  static bool refuse(const Connection& connection, const char* status) {
    if (status != nullptr) {
      const std::string text =
          std::string("HTTP/1.1 ") + status + "\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
      send(connection.socket, text.data(), text.size(), MSG_NOSIGNAL);
    }
    close(connection.socket);
    return true;
  }

  void answer(Connection connection) {
    bool closed = false, good = false;
    {
      RequestStream stream(&connection);
      good = process_request(stream, false, closed, nullptr);
    }
    if (!good || closed || ending_) {
      close(connection.socket);
    } else {
      connection.deadline = Clock::now() + kIdleTime;
      add(std::move(connection));
    }
  }

  const std::string root_;
  httplib::ThreadPool pool_;
  std::atomic<bool> ending_ = false;
  const int wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  std::mutex mutex_;
  std::vector<Connection> incoming_;  // for the reader
  std::thread reader_;
};

class Site {
 public:
  Site(const DagFile& file, const TileCutter& cutter, const ServerConfig& config)
      : cutter_(cutter),
        root_("/" + config.token + "/"),
        scene_(scene_json(file, cutter, {config.up, 1, true})),
        server_(root_) {
    server_.set_payload_max_length(0);
    // The default, SO_REUSEPORT, would share the port with another process.
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.set_tcp_nodelay(true);
    server_.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"Content-Security-Policy", "frame-ancestors 'none'"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"Cache-Control", "private, no-cache"}});
    server_.set_pre_routing_handler(
        [this](const Request& request, Response& response) { return admit(request, &response); });
    // admit() has checked the token, so the path begins with it.
    server_.Get(".*", [this](const Request& request, Response& response) {
      answer(request, request.path.substr(root_.size()), &response);
    });
  }

  BoundedServer& server() { return server_; }
  const OpenPages& pages() const { return pages_; }
  void stop() {
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
  BoundedServer server_;
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
    site.stop();
    listener.join();
    site.server().end();
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
