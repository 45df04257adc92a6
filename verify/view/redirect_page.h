// A page on disk, readable only by the user, that leads a browser to the viewer's URL.
//
// Every user of a machine sees the arguments of its processes, so the browser gets the path of this
// page and not the URL with its token (as Jupyter does).
#pragma once

#include <string>

namespace svdag {

class RedirectPage {
 public:
  // Creates the page in a new folder below $TMPDIR or /tmp. Error (kOutput) if that fails.
  explicit RedirectPage(const std::string& url);
  RedirectPage(const RedirectPage&) = delete;
  RedirectPage& operator=(const RedirectPage&) = delete;
  // Removes the page and its folder.
  ~RedirectPage();

  const std::string& path() const { return path_; }

 private:
  std::string folder_, path_;
};

}  // namespace svdag
