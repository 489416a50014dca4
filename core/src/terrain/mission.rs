//! The mission on a map: two flags, the bridge between them and the mission area. SI units, world frame.

/// Two bases, the bridge over the gorge between them, and the area the game is played in.
#[derive(Clone, Debug, PartialEq)]
pub struct Mission {
    /// Where each flag stands: x, y and the height of the ground there, metres.
    pub flags: [[f64; 3]; 2],
    /// The bridge over the gorge between the bases.
    pub bridge: Bridge,
    /// The ground the mission is played on.
    pub area: Area,
}

/// A straight level bridge over a gorge.
#[derive(Clone, Debug, PartialEq)]
pub struct Bridge {
    /// The middle of the deck's upper side, metres.
    pub centre: [f64; 3],
    /// Where the deck ends: x, y and the height of the ground there, metres. [`Bridge::LENGTH`] apart.
    pub ends: [[f64; 3]; 2],
    /// The deck's width, metres.
    pub width: f64,
    /// Height of the deck's upper side, metres: the same from end to end.
    pub deck_top: f64,
}

impl Bridge {
    /// Horizontal distance between the two ends, metres.
    pub const LENGTH: f64 = 128.0;
    /// Width of the deck, metres.
    pub const WIDTH: f64 = 16.0;
}

/// An axis-aligned rectangle on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// South-west corner, metres.
    pub min: [f64; 2],
    /// North-east corner, metres.
    pub max: [f64; 2],
}

impl Area {
    /// Size of a mission area, metres: east-west by north-south.
    pub const SIZE: [f64; 2] = [850.0, 900.0];

    /// The mission area centred on a point.
    #[must_use]
    pub fn centred(centre: [f64; 2]) -> Self {
        let half = [0.5 * Self::SIZE[0], 0.5 * Self::SIZE[1]];
        Self {
            min: [centre[0] - half[0], centre[1] - half[1]],
            max: [centre[0] + half[0], centre[1] + half[1]],
        }
    }

    /// Whether a point lies in the area, its border included.
    #[must_use]
    pub fn contains(&self, point: [f64; 2]) -> bool {
        (0..2).all(|axis| self.min[axis] <= point[axis] && point[axis] <= self.max[axis])
    }
}
