svdag-trace --help | head -n 2
