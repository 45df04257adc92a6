// Valleys, ridges and folds that meet a cell only in a corner, an edge or a face.
//
// A cell (an octree cube of 1 to 16 voxels a side) has a corner P in the region. Wings are
// triangles that extend from P away from the cell. Two wings with a common edge form a ridge (wings
// on both sides) or a fold (on the same side); for the opposite cell the same surface is a valley.
// One lattice step inwards or outwards decides whether the cell is touched.
#include "tests/stress/family.h"

namespace svdag {
namespace {

enum class Contact { kCorner, kEdge, kFace };

struct Cell {
  LatticePoint corner;
  LatticePoint away;  // +-1 per axis: the directions away from the cell
  int64_t side;
};

Cell draw_cell(const Spot& spot, StressRandom* random) {
  const int64_t side = spot.voxel() << random->below(5);
  LatticePoint corner = spot.corner(random);
  for (int a = 0; a < 3; ++a) corner[a] = corner[a] / side * side;
  return {corner, {random->sign(), random->sign(), random->sign()}, side};
}

// A wing tip: strictly away from the cell on the axes of `outward` (bits), free on the others.
LatticePoint tip(const Cell& cell, unsigned outward, StressRandom* random) {
  const int64_t reach = 2 * cell.side;
  LatticePoint d;
  for (int a = 0; a < 3; ++a) {
    d[a] = (outward >> a & 1) != 0 ? cell.away[a] * random->log_between(1, reach)
                                   : random->around(reach);
  }
  return cell.corner + d;
}

// The two ends of the edge that both wings share, along which they meet the cell.
std::array<LatticePoint, 2> spine(const Cell& cell, Contact contact, int w, StressRandom* random) {
  std::array<LatticePoint, 2> ends{cell.corner, cell.corner};
  switch (contact) {
    case Contact::kCorner:  // from the corner outwards
      ends[1] = tip(cell, 0b111, random);
      break;
    case Contact::kEdge:  // along the cell's edge of axis w, inside it or beyond its ends
      ends[0][w] -= cell.away[w] * random->between(0, cell.side);
      ends[1][w] -= cell.away[w] * random->between(-cell.side, 2 * cell.side);
      break;
    case Contact::kFace:  // anywhere in the plane of the face of axis w
      for (LatticePoint& end : ends) {
        for (int a = 0; a < 3; ++a) {
          if (a != w) end[a] -= cell.away[a] * random->between(-cell.side / 2, cell.side);
        }
      }
      break;
  }
  return ends;
}

Family contact_family(const char* name, Contact contact) {
  return {name, [contact](const Spot& spot, StressRandom* random) {
            Soup soup;
            for (int i = 0; i < 3; ++i) {
              const Cell cell = draw_cell(spot, random);
              const int w = random->axis();
              const auto ends = spine(cell, contact, w, random);
              unsigned outward = 0b111;
              if (contact == Contact::kEdge) outward &= ~(1U << w);
              if (contact == Contact::kFace) outward = 1U << w;
              const LatticePoint left = tip(cell, outward, random);
              LatticePoint right = tip(cell, outward, random);
              // A fold: nearly the same wing again.
              if (random->coin()) right = left + random->point(2);
              soup.push_back({{ends[0], ends[1], left}});
              soup.push_back({{ends[1], ends[0], right}});
              LatticePoint nudge(0);
              nudge[random->axis()] = random->around(1);
              for (size_t t = soup.size() - 2; t < soup.size(); ++t) {
                for (LatticePoint& p : soup[t].v) p += nudge;
              }
            }
            return soup;
          }};
}

}  // namespace

std::vector<Family> contact_families() {
  return {contact_family("contact_by_corner", Contact::kCorner),
          contact_family("contact_by_edge", Contact::kEdge),
          contact_family("contact_by_face", Contact::kFace)};
}

}  // namespace svdag
