svdag --version
svdag-verify --version
