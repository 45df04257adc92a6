// OpenVDB's grids of the value types that we use. Their code is taken from its library instead of
// being compiled again in each source file, which takes three times as long.
#pragma once

#include <openvdb/openvdb.h>

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

#ifndef SVDAG_FUZZ  // fuzzers see the branches of code that is compiled with them
extern template class tree::Tree<BoolTree::RootNodeType>;
extern template class tree::Tree<FloatTree::RootNodeType>;
extern template class tree::Tree<Int32Tree::RootNodeType>;
extern template class tree::Tree<MaskTree::RootNodeType>;
extern template class Grid<BoolTree>;
extern template class Grid<FloatTree>;
extern template class Grid<Int32Tree>;
extern template class Grid<MaskTree>;
#endif

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
