# Stored files of format version 1: every later version reads the same voxels from them.
svdag info "$TESTS/files/version1.svdag" | sed "s|$TESTS/||"
svdag-verify check "$TESTS/files/version1.svdag" | sed "s|$TESTS/||"
svdag export "$TESTS/files/version1.svdag" -q -o voxels.ply
sha256sum voxels.ply
svdag info "$TESTS/files/version1_half1.run" | sed "s|$TESTS/||"
svdag merge "$TESTS/files/version1_half1.run" "$TESTS/files/version1_half2.run" -q -o merged.svdag
cmp merged.svdag "$TESTS/files/version1.svdag" && echo "the runs make the file"
