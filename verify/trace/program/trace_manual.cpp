#include "verify/trace/program/trace_options.h"

namespace svdag {
namespace {

ManualOption value(std::vector<std::string> names, const char* value, const char* text,
                   std::vector<std::string> choices = {}, std::vector<std::string> endings = {}) {
  return {std::move(names), value, text, "", std::move(choices), std::move(endings)};
}

ManualOption flag(std::vector<std::string> names, const char* text) {
  return value(std::move(names), "", text);
}

}  // namespace

Manual trace_manual() {
  Manual manual;
  manual.command = "svdag-trace";
  manual.text =
      "Traces rays through a .svdag on the processor or a GPU, and says how many per second.";
  manual.operands = {value({"FILE"}, "", "The .svdag file", {}, {".svdag"})};
  manual.operands[0].required = true;
  manual.options = {
      value({"--device"}, "NAME", "Where: cpu or cuda (default cpu)", {"cpu", "cuda"}),
      flag({"--compare"}, "Both, and count the pixels that differ; exit 1 if any does"),
      value({"--size"}, "WxH", "Pixels (default 1280x720)"),
      value({"--preset"}, "NAME",
            "iso, front, back, left, right, top or inside, without --camera (default iso)",
            {"iso", "front", "back", "left", "right", "top", "inside"}),
      value({"--camera"}, "px,py,pz,tx,ty,tz[,fov]", "Position, target, angle of view in degrees"),
      value({"--up"}, "AXIS", "The axis that points up: x, y or z (default y)", {"x", "y", "z"}),
      value({"--light"}, "x,y,z[,radius]",
            "Where the light is, and how large (default: above what is seen)"),
      value({"--samples"}, "N", "soft, ao: rays per pixel, 1 to 4096 (default 64)"),
      value({"--reach"}, "LENGTH", "ao: how far they reach (default 0: all the way)"),
      value({"--cone"}, "DEGREES",
            "ao: half the angle of the cone in which they end early, 0 to 44, for example 9 "
            "(default 0, which is exact)"),
      flag({"--no-beams"}, "Primary rays start at the camera (same hits)"),
      value({"--rounds"}, "N", "The least time of N counts, 1 to 1000 (default 3)"),
      value({"-j", "--threads"}, "N", "Threads of the processor, 1 to 1024 (default: all)"),
      value({"--dump"}, "FILE",
            "Write 56 bytes per pixel, little-endian: u32 found, x, y, z, level, axis; f64 t; u32 "
            "blocked rays of shadow, soft, ao; u32 0, 0, 0",
            {}, {"*"}),
      value({"--picture"}, "FILE.ppm", "Write a picture of the answers", {}, {".ppm"}),
      flag({"-h", "--help"}, "Print this help message and exit"),
      flag({"-V", "--version"}, "Print the version and exit"),
  };
  manual.notes =
      std::string(
          "Sizes and pointers of the file are proven before a ray is sent, its checksums are not: "
          "svdag-verify check proves that it is what was baked.\n\n"
          "Example:\n  svdag-trace city.svdag --preset inside --cone 9\n\n") +
      kExitCodes;
  return manual;
}

}  // namespace svdag
