svdag help
