svdag-trace a.svdag --speed 9
