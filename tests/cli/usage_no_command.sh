svdag
