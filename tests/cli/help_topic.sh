svdag help rules
COLUMNS=44 svdag help exit-codes
