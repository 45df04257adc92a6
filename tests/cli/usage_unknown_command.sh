svdag bake
