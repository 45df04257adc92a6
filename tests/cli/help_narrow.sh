COLUMNS=40 svdag submit --help
COLUMNS=40 svdag-verify --help
