//! The observation: numbers that every task has, and what its scene and its goal add.

use super::landing::{HORIZON, Jets, landing};
use super::rows::{Columns, Rows};
use super::seen_ground;
use crate::armor::{GRAVITY, JUMP_GRACE_MS};
use crate::arms::{Arms, Arsenal};
use crate::error::{InputError, refuse};
use crate::player::Player;
use crate::real::{Int, Mask, Real, V3};
use crate::rules::Rules;
use crate::scene::{Group, Scene};
use crate::task::{Kind, OUTSIDE_MS, Run, apex};
use crate::terrain::Surface;

/// Observations lie in [-CLIP, CLIP].
pub const CLIP: f32 = 8.0;
/// Most samples of the fan.
const MAX_SAMPLES: usize = 4096;

/// A stretch of the observation.
#[derive(Clone, Debug, PartialEq)]
pub struct LayoutField {
    /// Its name.
    pub name: &'static str,
    /// How many numbers.
    pub count: usize,
    /// Unit of `number * scale`; empty where the number has none.
    pub unit: &'static str,
    /// What a number is multiplied by to get the unit.
    pub scale: f64,
}

/// What is observed: players side by side, and what is known of their worlds.
#[derive(Debug)]
pub struct Seen<'a, S: Scene, K: Kind, R: Real> {
    /// The players.
    pub player: &'a Player<S, R>,
    /// Their launchers, where they have any.
    pub arms: Option<&'a Arms<R>>,
    /// Their runs.
    pub run: &'a Run<K, R>,
    /// The ground.
    pub surface: &'a Surface<'a, R::Scalar>,
    /// The batch's rules.
    pub rules: &'a Rules<R::Scalar>,
    /// Constants of the launcher.
    pub arsenal: &'a Arsenal<R::Scalar>,
    /// What stands for the height of ground that does not exist, m.
    pub lowest: R,
}

/// Which observation a batch makes: horizontal vectors are (forward, right) of the player's yaw.
#[derive(Clone, Debug)]
pub struct Observation {
    /// Unit (forward, right) of every bearing.
    bearings: Vec<[f64; 2]>,
    ranges: Vec<f64>,
    landing: bool,
    jet_landings: bool,
}

/// Scales: speeds of a good skier, drop of a typical hill, way to a typical beacon.
const SPEED: f64 = 20.0;
const HEIGHT: f64 = 20.0;
const CLEARANCE: f64 = 30.0;
const DISTANCE: f64 = 400.0;
/// Half-way points of the bending features h / (h + 3 m) and 30 m / (30 m + d).
const LOW: f64 = 3.0;
const NEAR: f64 = 30.0;
/// Height of a low marker: the highest are within the clip.
const ALOFT: f64 = 40.0;
/// What is close: the reach of an explosion, and somewhat more, m.
const CLOSE: f64 = 10.0;

/// Names of what is seen of landings: falling, and under each of `Jets::ways`.
const LANDINGS: [[&str; 5]; 5] = [
    ["landing_time", "landing_normal", "landing_impact", "landing_slope", "landing_rise"],
    ["burst_time", "burst_normal", "burst_impact", "burst_slope", "burst_rise"],
    ["burn_time", "burn_normal", "burn_impact", "burn_slope", "burn_rise"],
    ["left_time", "left_normal", "left_impact", "left_slope", "left_rise"],
    ["right_time", "right_normal", "right_impact", "right_slope", "right_rise"],
];

impl Observation {
    /// An observation with a fan of terrain at every bearing (degrees, 0 ahead, positive to the left)
    /// and range (metres): its height over the ground below the player, over the range. So the fan is
    /// the shape of the ground, about [-1, 1], whatever the player's own height (which stands beside
    /// it). With the ballistic landing or without it.
    ///
    /// # Errors
    /// If a bearing or a range is out of range, or there are more than 4096 samples.
    pub fn new(bearings: &[f64], ranges: &[f64], landing: bool) -> Result<Self, InputError> {
        if bearings.len() * ranges.len() > MAX_SAMPLES {
            refuse!(
                "fan: expected at most {MAX_SAMPLES} samples, got {} bearings x {} ranges",
                bearings.len(),
                ranges.len()
            );
        }
        if let Some(b) = bearings.iter().find(|b| b.is_nan() || b.abs() > 180.0) {
            refuse!("fan_bearings: expected -180 to 180 degrees, got {b}");
        }
        if let Some(r) = ranges.iter().find(|r| !(1.0..=2000.0).contains(*r)) {
            refuse!("fan_ranges: expected 1 to 2000 m, got {r}");
        }
        let bearings = bearings
            .iter()
            .map(|b| {
                let angle = b.to_radians();
                [libm::cos(angle), -libm::sin(angle)]
            })
            .collect();
        Ok(Self { bearings, ranges: ranges.to_vec(), landing, jet_landings: false })
    }

    /// With the landings under jets, or without them: after a burst of half a second up, after burning all the
    /// energy, and after bursts to the left and to the right.
    #[must_use]
    pub fn with_jet_landings(self, jet_landings: bool) -> Self {
        Self { jet_landings, ..self }
    }

    /// Which of [`LANDINGS`] are seen.
    fn landings(&self) -> core::ops::Range<usize> {
        usize::from(!self.landing)..if self.jet_landings { LANDINGS.len() } else { 1 }
    }

    /// The layout of a row.
    #[must_use]
    pub fn layout<S: Scene, K: Kind>(&self, max_energy: f64, max_damage: f64) -> Vec<LayoutField> {
        let mut layout = Vec::new();
        let mut add = |name, count, unit, scale| layout.push(LayoutField { name, count, unit, scale });
        add("velocity", 3, "m/s", SPEED);
        add("speed", 1, "m/s", SPEED);
        let [direction, distance, nearness, height] = if K::ALOFT {
            ["goal_direction", "goal_distance", "goal_nearness", "goal_height"]
        } else {
            ["beacon_direction", "beacon_distance", "beacon_nearness", "beacon_height"]
        };
        add(direction, 2, "", 1.0);
        add(distance, 1, "m", DISTANCE);
        add(nearness, 1, "", 1.0);
        add(height, 1, "m", if K::ALOFT { ALOFT } else { HEIGHT });
        add("closing_speed", 1, "m/s", SPEED);
        add("lateral_speed", 1, "m/s", SPEED);
        add("ground_normal", 2, "", 1.0);
        add("height_bend", 1, "", 1.0);
        add("height", 1, "m", CLEARANCE);
        if S::Energy::<f32>::MODELED {
            add("energy", 1, "energy", max_energy);
        }
        if S::Contact::<f32>::MODELED {
            add("jump_grace", 1, "ms", f64::from(JUMP_GRACE_MS));
        }
        if S::Jet::<f32>::MODELED {
            add("jetting", 1, "", 1.0);
        }
        if S::Damage::<f32>::MODELED {
            add("damage", 1, "damage", max_damage);
        }
        for [time, normal, impact, slope, rise] in &LANDINGS[self.landings()] {
            add(time, 1, "s", HORIZON);
            add(normal, 2, "", 1.0);
            add(impact, 1, "m/s", SPEED);
            add(slope, 1, "", 1.0);
            add(rise, 1, "m", HEIGHT);
        }
        if self.samples() > 0 {
            add("fan", self.samples(), "", 1.0);
        }
        if K::ALOFT {
            add("goal_near", 3, "m", CLOSE);
            add("apex_gap", 1, "m", ALOFT);
        }
        if S::Arms::<f32>::MODELED {
            add("reload", 1, "", 1.0);
            add("ammo", 1, "", 1.0);
            add("disc", 3, "m", CLOSE);
            add("disc_flying", 1, "", 1.0);
        }
        if K::Flag::<f32>::MODELED {
            add("carrying", 1, "", 1.0);
            add("outside_time", 1, "s", f64::from(OUTSIDE_MS) / 1000.0);
            add("axis", 2, "", 1.0);
            add("axis_distance", 1, "m", DISTANCE);
        }
        layout
    }

    /// Numbers in the fan: bearing by bearing, near to far.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.bearings.len() * self.ranges.len()
    }

    /// Numbers in a row.
    #[must_use]
    pub fn size<S: Scene, K: Kind>(&self) -> usize {
        self.layout::<S, K>(1.0, 1.0).iter().map(|f| f.count).sum()
    }

    /// Writes the rows of the first `players` lanes, one after the other.
    ///
    /// # Panics
    /// If `rows` is not so many times [`Observation::size`] long.
    #[inline(always)]
    pub fn write<S: Scene, K: Kind, R: Real>(
        &self,
        seen: &Seen<'_, S, K, R>,
        rows: &mut [f32],
        players: usize,
        columns: &mut Columns<R>,
    ) {
        let Seen { player: p, run, surface, rules, lowest, .. } = *seen;
        let (zero, one) = (R::zero(), R::lit(1.0));
        let (sin, cos) = p.yaw.sin_cos();
        let v = p.velocity;
        let speed = (v.x * v.x + v.y * v.y).sqrt();
        let (bx, by) = run.to_goal(p.position, [p.tile_x, p.tile_y], surface);
        let distance = (bx * bx + by * by).sqrt();
        let safe = distance.max(R::lit(1e-3));
        let (ux, uy) = (bx / safe, by / safe);
        let ground = seen_ground::<R>(surface, p.map, p.position.x, p.position.y, lowest);
        let below = ground.height;
        let height = (p.position.z - below).max(zero);
        let normal = ground.normal();

        let mut row = Rows::new(rows, rows.len() / players, players, columns);
        let by_speed = R::lit(1.0 / SPEED);
        let (forward, right) = turned(v.x, v.y, sin, cos);
        row.push(forward, by_speed);
        row.push(right, by_speed);
        row.push(v.z, by_speed);
        row.push(speed, by_speed);
        let (forward, right) = turned(ux, uy, sin, cos);
        row.push(forward, one);
        row.push(right, one);
        row.push(distance, R::lit(1.0 / DISTANCE));
        row.push(R::lit(NEAR) / (R::lit(NEAR) + distance), one);
        row.push(run.goal.z - p.position.z, R::lit(1.0 / if K::ALOFT { ALOFT } else { HEIGHT }));
        row.push(v.x * ux + v.y * uy, by_speed);
        row.push(v.x * uy - v.y * ux, by_speed);
        let (forward, right) = turned(normal.x, normal.y, sin, cos);
        row.push(forward, one);
        row.push(right, one);
        row.push(height / (height + R::lit(LOW)), one);
        row.push(height, R::lit(1.0 / CLEARANCE));
        if S::Energy::<R>::MODELED {
            row.push(p.energy.get(one), one / R::splat(rules.max_energy));
        }
        if S::Contact::<R>::MODELED {
            let grace = R::Int::splat(JUMP_GRACE_MS) - p.contact().age;
            row.push(R::from_int(grace.clamp(0, JUMP_GRACE_MS)), R::lit(1.0 / f64::from(JUMP_GRACE_MS)));
        }
        if S::Jet::<R>::MODELED {
            row.push(R::select(p.jetting.get(R::Mask::splat(false)), one, zero), one);
        }
        if S::Damage::<R>::MODELED {
            row.push(p.damage.get(one), one / R::splat(rules.max_damage));
        }
        let mut ways = [None; LANDINGS.len()];
        if self.jet_landings {
            for (way, jets) in ways[1..].iter_mut().zip(Jets::ways(p, rules, speed)) {
                *way = Some(jets);
            }
        }
        for jets in &ways[self.landings()] {
            let there = landing(p, &ground, R::lit(GRAVITY), jets.as_ref(), surface, lowest);
            let [gx, gy] = there.slope;
            let up = one / (gx * gx + gy * gy + one).sqrt();
            let [vx, vy] = there.velocity;
            let along = (gx * vx + gy * vy) / (vx * vx + vy * vy).sqrt().max(one);
            let (forward, right) = turned(-gx * up, -gy * up, sin, cos);
            row.push(there.time, R::lit(1.0 / HORIZON));
            row.push(forward, one);
            row.push(right, one);
            row.push(there.impact, by_speed);
            row.push(along, one);
            row.push(there.rise, R::lit(1.0 / HEIGHT));
        }
        for &[ahead, aside] in &self.bearings {
            let (ahead, aside) = (R::lit(ahead), R::lit(aside));
            let dx = aside * cos - ahead * sin;
            let dy = ahead * cos + aside * sin;
            for &range in &self.ranges {
                let range = R::lit(range);
                let (x, y) = (p.position.x + dx * range, p.position.y + dy * range);
                let z = seen_ground::<R>(surface, p.map, x, y, lowest).height;
                row.push((z - below) / range, one);
            }
        }
        if K::ALOFT {
            let (forward, right) = turned(bx, by, sin, cos);
            let close = R::lit(1.0 / CLOSE);
            row.push(forward, close);
            row.push(right, close);
            row.push(run.goal.z - p.position.z, close);
            row.push(run.goal.z - apex(p), R::lit(1.0 / ALOFT));
        }
        if let Some(arms) = seen.arms {
            write_arms(&mut row, arms, seen, (sin, cos));
        }
        if let Some(flag) = run.flag.as_ref() {
            let ticks = R::from_int(flag.outside) * R::splat(rules.dt);
            row.push(R::select(flag.carried, one, zero), one);
            row.push(ticks, R::lit(1000.0 / f64::from(OUTSIDE_MS)));
            // The way from the stand that is left to the one that is sought: bases open along it.
            let ahead = flag.enemy - flag.home;
            let ahead = V3::select(flag.carried, V3::zero() - ahead, ahead);
            let apart = (ahead.x * ahead.x + ahead.y * ahead.y).sqrt().max(R::lit(1e-3));
            let (ax, ay) = (ahead.x / apart, ahead.y / apart);
            let (forward, right) = turned(ax, ay, sin, cos);
            row.push(forward, one);
            row.push(right, one);
            row.push(bx * ay - by * ax, R::lit(1.0 / DISTANCE));
        }
        row.finish();
    }
}

/// The launcher: how far it is from ready, what is left in it, and the last disc under way.
#[inline(always)]
fn write_arms<S: Scene, K: Kind, R: Real>(
    row: &mut Rows<'_, R>,
    arms: &Arms<R>,
    seen: &Seen<'_, S, K, R>,
    (sin, cos): (R, R),
) {
    let (zero, one) = (R::zero(), R::lit(1.0));
    let arsenal = seen.arsenal;
    row.push(R::from_int(arms.cooldown) / R::from_int(R::Int::splat(arsenal.cycle.max(1))), one);
    row.push(R::from_int(arms.ammo) / R::from_int(R::Int::splat(arsenal.ammo.max(1))), one);
    let mut youngest = R::Int::splat(i32::MAX);
    let mut there = V3::zero();
    let mut any = R::Mask::splat(false);
    for slot in &arms.slots {
        let flying = slot.flying();
        if !flying.any() {
            continue;
        }
        let newer = flying.and(slot.age.lt(youngest));
        let tiles = [slot.tile_x - seen.player.tile_x, slot.tile_y - seen.player.tile_y];
        let (x, y) = seen.surface.tiles_apart::<R>(tiles[0], tiles[1]);
        let way = slot.position - seen.player.position + V3::new(x, y, zero);
        there = V3::select(newer, way, there);
        youngest = R::Int::select(newer, slot.age, youngest);
        any = any.or(flying);
    }
    let (forward, right) = turned(there.x, there.y, sin, cos);
    let close = R::lit(1.0 / CLOSE);
    row.push(forward, close);
    row.push(right, close);
    row.push(there.z, close);
    row.push(R::select(any, one, zero), one);
}

/// (forward, right) parts of a horizontal vector, for the sine and cosine of the yaw.
#[inline(always)]
fn turned<R: Real>(x: R, y: R, sin: R, cos: R) -> (R, R) {
    (y * cos - x * sin, x * cos + y * sin)
}
