//! Terrain: a heightfield of squares cut in a checkerboard, and what can be asked of it.
