//! The solids of a generated mission: a base with a flag stand and a tower at each flag, and the bridge.

use super::solid::{Placement, Solid};
use crate::terrain::mission::{Bridge, Mission};
use glam::{DVec2, DVec3, Vec3Swizzles};

/// A part of a base: a box, by its least and greatest coordinates in metres. x to the right and y towards the other
/// base, both from the flag; z from the floor, or [`DOWN`] for what reaches below the ground.
type Part = (&'static str, [f64; 3], [f64; 3]);

/// Below the lowest ground under a part, by [`SUNK`].
const DOWN: f64 = f64::NEG_INFINITY;
/// How far foundations, piers and the feet of ramps reach into the ground, m.
const SUNK: f64 = 1.0;
/// The floor above the highest ground under it, m.
const RAISED: f64 = 0.25;
/// Height of a flag stand above the floor, m: stepped up on by every armor.
const STAND: f64 = 0.4;

/// A base: a hall of 24 x 24 m, open towards the other base, with a door of 6 x 5 m in its back, and 6 m high
/// inside, twice what the heavy needs; a flag stand in its middle and a tower at a back corner.
const BASE: [Part; 9] = [
    ("floor", [-12.0, -12.0, DOWN], [12.0, 12.0, 0.0]),
    ("left wall", [-12.0, -12.0, -0.5], [-11.0, 8.0, 6.5]),
    ("right wall", [11.0, -12.0, -0.5], [12.0, 8.0, 6.5]),
    ("back wall, left", [-11.5, -12.0, -0.5], [-3.0, -11.0, 6.5]),
    ("back wall, right", [3.0, -12.0, -0.5], [11.5, -11.0, 6.5]),
    ("lintel", [-3.5, -12.0, 5.0], [3.5, -11.0, 6.5]),
    ("roof", [-12.0, -12.0, 6.0], [12.0, 8.0, 7.0]),
    ("flag stand", [-1.5, -1.5, -0.5], [1.5, 1.5, STAND]),
    ("tower", [12.0, -16.0, DOWN], [16.0, -12.0, 15.0]),
];

/// Half the width of the ramps before the open side and the door, m, and how far they reach out.
const RAMPS: [(f64, f64); 2] = [(11.0, 12.0), (3.0, 12.0)];

/// Thickness of the deck, m.
const DECK: f64 = 1.0;
/// How far the ramps at the deck's ends reach out, m.
const APPROACH: f64 = 12.0;
/// Where the pairs of piers stand along the deck, and how far from its middle, m.
const PIERS: ([f64; 4], f64) = ([-40.0, -14.0, 14.0, 40.0], 5.0);
/// Side of a pier, m.
const PIER: f64 = 2.0;

/// The solids of a mission.
#[derive(Clone, Debug)]
pub struct MissionSolids {
    /// Bases, towers and bridge: 9 boxes and 2 ramps for each base, then the bridge.
    pub solids: Vec<Solid>,
    /// Where each flag stands now: in the middle of its stand's upper side, m.
    pub flags: [[f64; 3]; 2],
}

/// The solids of a mission on its ground, `ground(x, y)` being its height, m.
#[must_use]
pub fn solids(mission: &Mission, ground: impl Fn(f64, f64) -> f64) -> MissionSolids {
    let mut builder = Builder { ground, solids: Vec::new() };
    let flat = mission.flags.map(|flag| DVec3::from(flag).xy());
    let flags = [0, 1].map(|k| builder.base(k, flat[k], flat[1 - k]).to_array());
    builder.bridge(&mission.bridge);
    MissionSolids { solids: builder.solids, flags }
}

/// A place on the ground, and which way is forward.
struct Frame {
    origin: DVec2,
    yaw: f64,
    forward: DVec2,
}

impl Frame {
    fn new(origin: DVec2, towards: DVec2) -> Self {
        let ahead = towards - origin;
        let forward = if ahead == DVec2::ZERO { DVec2::Y } else { ahead / ahead.length() };
        Self { origin, yaw: libm::atan2(-forward.x, forward.y), forward }
    }

    fn at(&self, x: f64, y: f64) -> DVec2 {
        self.origin + x * DVec2::new(self.forward.y, -self.forward.x) + y * self.forward
    }
}

struct Builder<G> {
    ground: G,
    solids: Vec<Solid>,
}

impl<G: Fn(f64, f64) -> f64> Builder<G> {
    /// Lowest and highest ground under a rectangle, on a lattice of half a metre.
    fn under(&self, frame: &Frame, low: [f64; 2], high: [f64; 2]) -> (f64, f64) {
        let steps = |axis: usize| ((high[axis] - low[axis]) / 0.5).ceil().max(1.0) as usize;
        let along =
            |axis: usize, k: usize| low[axis] + (high[axis] - low[axis]) * (k as f64 / steps(axis) as f64);
        let places = (0..=steps(0)).flat_map(|i| (0..=steps(1)).map(move |j| (i, j)));
        places.fold((f64::INFINITY, f64::NEG_INFINITY), |(lowest, highest), (i, j)| {
            let place = frame.at(along(0, i), along(1, j));
            let height = (self.ground)(place.x, place.y);
            (lowest.min(height), highest.max(height))
        })
    }

    /// A box in a frame, z in the world.
    fn part(&mut self, name: &str, frame: &Frame, low: DVec3, high: DVec3) {
        let middle = 0.5 * (low + high);
        let centre = frame.at(middle.x, middle.y).extend(middle.z);
        self.solids.push(Solid::cuboid(name, high - low, centre, frame.yaw));
    }

    /// A ramp from an edge at (+-half_width, y) and height `top` down to below the ground `reach` beyond it.
    fn ramp(&mut self, name: &str, frame: &Frame, half_width: f64, edge: f64, reach: f64, top: f64) {
        let (x, far) = (half_width, edge + reach);
        let (lowest, _) = self.under(frame, [-x, far.min(edge)], [x, far.max(edge)]);
        let foot = lowest.min(top) - SUNK;
        let point = |x: f64, y: f64, z: f64| frame.at(x, y).extend(z);
        let profile = [(edge, top), (far, foot), (edge, foot)];
        let points = profile.iter().flat_map(|&(y, z)| [point(-x, y, z), point(x, y, z)]).collect();
        self.solids.push(Solid::hull(name, points, Placement::default()));
    }

    /// A base at a flag, open towards another place; returns where its flag stands.
    fn base(&mut self, number: usize, flag: DVec2, other: DVec2) -> DVec3 {
        let frame = Frame::new(flag, other);
        let (_, low, high) = BASE[0];
        let floor = self.under(&frame, [low[0], low[1]], [high[0], high[1]]).1 + RAISED;
        for (name, low, high) in BASE {
            let (lowest, _) = self.under(&frame, [low[0], low[1]], [high[0], high[1]]);
            let bottom = if low[2] == DOWN { lowest.min(floor) - SUNK } else { floor + low[2] };
            let (low, high) = (DVec3::new(low[0], low[1], bottom), DVec3::from(high).with_z(floor + high[2]));
            self.part(&format!("base {number}: {name}"), &frame, low, high);
        }
        let [front, back] = RAMPS;
        self.ramp(&format!("base {number}: front ramp"), &frame, front.0, high[1], front.1, floor);
        self.ramp(&format!("base {number}: back ramp"), &frame, back.0, low[1], -back.1, floor);
        flag.extend(floor + STAND)
    }

    fn bridge(&mut self, bridge: &Bridge) {
        let frame = Frame::new(DVec3::from(bridge.centre).xy(), DVec3::from(bridge.ends[1]).xy());
        let (half, end, top) = (0.5 * bridge.width, 0.5 * Bridge::LENGTH, bridge.deck_top);
        let (low, high) = (DVec3::new(-half, -end, top - DECK), DVec3::new(half, end, top));
        self.part("bridge: deck", &frame, low, high);
        self.ramp("bridge: approach 0", &frame, half, -end, -APPROACH, top);
        self.ramp("bridge: approach 1", &frame, half, end, APPROACH, top);
        let (along, aside) = PIERS;
        let places = along.iter().flat_map(|&y| [(-aside, y), (aside, y)]);
        for (k, (x, y)) in places.enumerate() {
            let side = 0.5 * PIER;
            let (lowest, _) = self.under(&frame, [x - side, y - side], [x + side, y + side]);
            // Inside the deck at its upper end, so that no seam is left.
            let (bottom, upper) = (lowest - SUNK, top - 0.5 * DECK);
            if bottom < upper - SUNK {
                let (low, high) =
                    (DVec3::new(x - side, y - side, bottom), DVec3::new(x + side, y + side, upper));
                self.part(&format!("bridge: pier {k}"), &frame, low, high);
            }
        }
    }
}
