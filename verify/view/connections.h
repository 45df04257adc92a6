// The connections of a server, as far as they wait for a request.
//
// One thread accepts connections and reads the heads of their requests; the caller gets a
// connection together with a whole head. So a connection that sends nothing, or sends slowly,
// takes neither a thread nor much memory: kMaxHeadBytes of a head, kHeadTime for it, and at most
// kMaxWaiting connections (or half of the open files that the process may have). If there are
// more, the oldest is closed: a client in good order sends its head at once.
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace svdag {

// Owns a file descriptor.
class Socket {
 public:
  Socket() = default;
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~Socket();
  int get() const { return descriptor_; }

 private:
  int descriptor_ = -1;
};

class Connections {
 public:
  static constexpr size_t kMaxHeadBytes = 16384;
  static constexpr size_t kMaxWaiting = 2048;
  static constexpr std::chrono::seconds kHeadTime{5};

  // Receives a connection that has sent a head, which may be followed by other bytes, or more than
  // kMaxHeadBytes without its end.
  using Ready = std::function<void(Socket connection, std::string received)>;

  // `listener`: a listening socket, owned by the caller.
  explicit Connections(int listener);

  // Waits until something arrives, at most for `timeout`, and passes the requests that are whole.
  void wait(std::chrono::milliseconds timeout, const Ready& ready);
  // Waits for the next request of a connection. Any thread may call this during wait().
  void put_back(Socket connection);
  // Keeps a connection open until its client closes it.
  void hold(Socket connection) { held_.push_back(std::move(connection)); }
  size_t held() const { return held_.size(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    Socket socket;
    std::string received;
    Clock::time_point deadline;
  };

  void accept_all();
  void add(Socket connection);
  // Closes, passes or keeps a connection that has data.
  bool keeps_waiting(Waiting* connection, const Ready& ready) const;

  int listener_;
  size_t max_waiting_;
  Socket wake_;                   // an eventfd: connections were put back
  std::vector<Waiting> waiting_;  // in order of their deadlines
  std::vector<Socket> held_;
  std::mutex mutex_;
  std::vector<Socket> put_back_;  // guarded by mutex_
};

}  // namespace svdag
