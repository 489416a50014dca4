//! A touch that becomes deeper by less than 0.1 mm is let go, so that a gap just as wide as a player does not hold him.
//! Nothing summed those up. In a wedge, at ticks of a few milliseconds, a player crept through the skin of both walls
//! until he overlapped each by more than a millimetre; from then on only the one with the shorter way out counted,
//! and he slid along it through the other, out of a closed room.

use crate::common::solids::{block, built};
use glam::DVec3;

#[test]
fn creeping_adds_up() {
    let wall = built(&[block([0.0, -5.0, -5.0], [1.0, 5.0, 5.0])]);
    for step in [1e-6, 1e-5, 9e-5] {
        let mut depth = 1e-6;
        while wall.sweep_box(DVec3::new(depth - 0.5, 0.0, 0.0), DVec3::X * step, 0.5, 2.3).is_none() {
            depth += step;
            assert!(depth < 6e-4, "{depth} m deep by steps of {step} m");
        }
    }
}
