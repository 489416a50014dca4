//! The enemy flag: taken, carried home, lost outside the mission area (docs/physics.md, section 9).

use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::scene::Scene;
use crate::terrain::Surface;

/// Time outside the mission area after which a carried flag goes home, ms: three warnings, 1.5 s apart.
pub const OUTSIDE_MS: u32 = 4500;
/// The count of flags taken stops here.
pub const MOST_TAKEN: i32 = 1 << 30;

/// The flags of one player's mission, or of as many as `R` has lanes. Places are local, in the first tile.
#[derive(Clone, Copy, Debug)]
pub struct Flag<R: Real> {
    /// Whether the player has the enemy flag.
    pub carried: R::Mask,
    /// Ticks that he has been outside the mission area with it.
    pub outside: R::Int,
    /// How often he took it.
    pub taken: R::Int,
    /// Where the enemy flag stands, m.
    pub enemy: V3<R>,
    /// Where his own stands, m.
    pub home: V3<R>,
    /// South-west corner of the mission area, then the north-east one, m from the first tile's centre.
    pub area: [R; 4],
}

impl<R: Real> Flag<R> {
    /// No mission.
    #[must_use]
    pub fn idle() -> Self {
        let zero = R::Int::splat(0);
        Self {
            carried: R::Mask::splat(false),
            outside: zero,
            taken: zero,
            enemy: V3::zero(),
            home: V3::zero(),
            area: [R::zero(); 4],
        }
    }

    /// Who is outside the mission area.
    #[inline(always)]
    pub fn is_outside<S: Scene>(&self, p: &Player<S, R>, surface: &Surface<'_, R::Scalar>) -> R::Mask {
        let (x, y) = surface.tiles_apart::<R>(p.tile_x, p.tile_y);
        let (x, y) = (p.position.x + x, p.position.y + y);
        let [west, south, east, north] = self.area;
        x.lt(west).or(y.lt(south)).or(east.lt(x)).or(north.lt(y))
    }

    /// Way from one stand to the other, m.
    #[inline(always)]
    pub fn apart(&self) -> R {
        (self.home - self.enemy).length()
    }

    /// `a` where the mask is set, `b` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn select(mask: R::Mask, a: &Self, b: &Self) -> Self {
        let mut area = a.area;
        area.iter_mut().zip(&b.area).for_each(|(a, &b)| *a = R::select(mask, *a, b));
        Self {
            carried: mask.pick(a.carried, b.carried),
            outside: R::Int::select(mask, a.outside, b.outside),
            taken: R::Int::select(mask, a.taken, b.taken),
            enemy: V3::select(mask, a.enemy, b.enemy),
            home: V3::select(mask, a.home, b.home),
            area,
        }
    }

    /// The flag in one lane.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Flag<R::Scalar> {
        Flag {
            carried: self.carried.lane(lane),
            outside: self.outside.lane(lane),
            taken: self.taken.lane(lane),
            enemy: self.enemy.lane(lane),
            home: self.home.lane(lane),
            area: self.area.map(|x| x.lane(lane)),
        }
    }

    /// Overwrites one lane.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, flag: &Flag<R::Scalar>) {
        self.carried.set_lane(lane, flag.carried);
        self.outside.set_lane(lane, flag.outside);
        self.taken.set_lane(lane, flag.taken);
        self.enemy.set_lane(lane, flag.enemy);
        self.home.set_lane(lane, flag.home);
        self.area.iter_mut().zip(flag.area).for_each(|(mine, x)| mine.set_lane(lane, x));
    }
}
