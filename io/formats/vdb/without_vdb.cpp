// Replaces vdb_*.cpp in builds without OpenVDB.
#ifndef SVDAG_HAS_OPENVDB

#include "io/formats/vdb.h"
#include "streaming/error.h"

namespace svdag {
namespace {

[[noreturn]] void fail_without_vdb() {
  fail_usage("this program was built without OpenVDB: build it with -DSVDAG_OPENVDB=ON");
}

}  // namespace

std::unique_ptr<VdbWriter> make_vdb_writer() {
  fail_without_vdb();
}

std::unique_ptr<VdbGrid> read_vdb(const std::string&, const std::string&,
                                  const std::optional<ValueRange>&, bool) {
  fail_without_vdb();
}

}  // namespace svdag

#endif
