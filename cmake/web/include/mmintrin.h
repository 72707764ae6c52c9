// MMX, which emscripten lacks and Eigen only includes.
