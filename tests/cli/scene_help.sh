svdag-scene --help
