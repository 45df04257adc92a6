svdag-scene city
