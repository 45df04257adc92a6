// Serves the viewer's page, the scene and its tiles to browsers of this machine.
//
// It listens only on 127.0.0.1 and only reads. The URL has a random token, which other users and
// web pages do not know; and requests must name this machine as their host, so that a web page
// whose name is made to lead here (DNS rebinding) is refused. Tiles are cut on demand, and so are
// their colours: colours/PATH/LEVEL.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "io/dag/colours/dag_colours.h"
#include "verify/view/page.h"

namespace svdag {

struct ServerConfig {
  int port = 0;                     // 0: any that is free
  std::string token = {};           // in the URL; empty: a random one
  int up = 1;                       // axis
  bool keep = false;                // go on when no page is open
  std::chrono::seconds linger{10};  // else: end when no page has been open for so long
};

// Serves until Ctrl-C (Interrupted), or until the page has been closed. Calls ready(url) once.
// `colours`: of the file, if it has any. Error (kUsage) if the port is in use.
void serve(const DagFile& file, const TileCutter& cutter, const DagColours* colours,
           const ServerConfig& config, const std::function<void(const std::string& url)>& ready);

}  // namespace svdag
