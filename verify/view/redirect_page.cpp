#include "verify/view/redirect_page.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <span>

#include "streaming/file/file.h"
#include "streaming/file/system_call.h"

namespace svdag {

RedirectPage::RedirectPage(const std::string& url) {
  const char* const temporary = std::getenv("TMPDIR");
  folder_ = std::string(temporary != nullptr && *temporary != 0 ? temporary : "/tmp") +
            "/svdag-view-XXXXXX";
  if (::mkdtemp(folder_.data()) == nullptr)  // mode 0700
    fail_call(ExitCode::kOutput, "cannot create a page for the browser (see --no-open)", folder_,
              errno);
  path_ = folder_ + "/open.html";
  const std::string text =
      "<!DOCTYPE html>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"refresh\" content=\"0; url=" +
      url + "\">\n<title>svdag</title>\n<a href=\"" + url + "\">Open the viewer</a>\n";
  try {
    File page = File::create_anonymous(folder_, path_, 0600);
    page.write_at(0, std::as_bytes(std::span(text)));
    page.link_as(path_);
  } catch (...) {
    std::filesystem::remove(folder_);
    throw;
  }
}

RedirectPage::~RedirectPage() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

}  // namespace svdag
