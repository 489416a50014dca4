//! One test for each defect that was found and mended; each opens with what it caught.

#[path = "../common/mod.rs"]
mod common;
mod creeping_into_a_face;
mod hulls_of_thin_walls;
