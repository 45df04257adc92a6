# A file of an unknown version is reported as such, not as damaged.
for file in version1.svdag version1_half1.run; do
  { head -c 8 "$TESTS/files/$file"; printf '\002'; tail -c +10 "$TESTS/files/$file"; } > "later_$file"
done
svdag info later_version1.svdag || echo "exit $?"
svdag-verify check later_version1.svdag || echo "exit $?"
svdag merge later_version1_half1.run "$TESTS/files/version1_half2.run" -o merged.svdag || echo "exit $?"
