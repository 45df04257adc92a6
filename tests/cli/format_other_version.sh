# A file of an unknown version is reported as such, not as damaged.
later() { head -c 8 "$TESTS/files/$1"; printf "$2"; tail -c +10 "$TESTS/files/$1"; }
later version1.svdag '\003' > later_version1.svdag
later version1_half1.run '\002' > later_version1_half1.run
svdag info later_version1.svdag || echo "exit $?"
svdag-verify check later_version1.svdag || echo "exit $?"
svdag merge later_version1_half1.run "$TESTS/files/version1_half2.run" -o merged.svdag || echo "exit $?"
