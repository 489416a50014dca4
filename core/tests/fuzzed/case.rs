//! A small world, a player and his keys, and what must hold of every tick in every form of the movement.

use discjump_core::armor::ARMORS;
use discjump_core::batch::{Bodies, RawInput, SimulatorSetup};
use discjump_core::movement::{Anyway, Engine, Fast, Movement, Sliced, Swept};
use discjump_core::player::Player;
use discjump_core::real::{Scalar, V3};
use discjump_core::rules::{Physics, Rules};
use discjump_core::scene::{Has, Sandbox};
use discjump_core::terrain::{Edge, Heightfield, Maps, SurfaceKind};
use discjump_core::tick::tick;

type Body<T> = Player<Sandbox, T>;

/// Everything that is drawn.
#[derive(Clone, Debug)]
pub struct Case {
    pub rows: usize,
    pub cols: usize,
    /// Side of a square, m.
    pub square: f64,
    pub edge: Edge,
    pub surface: SurfaceKind,
    /// Heights, m, of as many vertices as there are, repeated where they are fewer.
    pub heights: Vec<f64>,
    /// Index into the armors.
    pub armor: usize,
    pub pack: bool,
    pub tick_ms: u32,
    pub ski_bug: Option<bool>,
    /// `hysteresis`, `clamp_fixup`, `fixup_swept`.
    pub switches: [bool; 3],
    /// In squares from the middle of the map.
    pub place: [f64; 2],
    /// Above the ground, m; never below it.
    pub above: f64,
    pub velocity: [f64; 3],
    pub yaw: f64,
    /// Share of a full tank.
    pub energy: f64,
    pub friction: f64,
    pub touched: bool,
    pub jump_age: i32,
    pub keys: Vec<Keys>,
}

/// Forward, strafe, jump, jet, turn in rad/s: one tick's.
pub type Keys = (i8, i8, bool, bool, f64);

impl Case {
    pub fn terrain(&self) -> Heightfield {
        let (rows, cols) = (self.rows, self.cols);
        let at = |i: usize, j: usize| {
            let (i, j) = if self.edge == Edge::Tile { (i % (cols - 1), j % (rows - 1)) } else { (i, j) };
            // What every arithmetic reads alike.
            f64::from(self.heights[(j * cols + i) % self.heights.len()] as f32)
        };
        let heights = (0..rows * cols).map(|k| at(k % cols, k / cols)).collect();
        let made = Heightfield::new(heights, rows, cols, self.square, [0.0, 0.0], self.edge);
        made.expect("a possible terrain").with_surface(self.surface)
    }

    fn physics(&self) -> Physics {
        let [hysteresis, clamp_fixup, fixup_swept] = self.switches;
        Physics { ski_bug: self.ski_bug, hysteresis, clamp_fixup, fixup_swept, ..Physics::default() }
    }

    fn inputs(&self) -> impl Iterator<Item = RawInput> {
        self.keys.iter().map(|&(forward, strafe, jump, jet, turn)| RawInput {
            forward,
            strafe,
            jump: u8::from(jump),
            jet: u8::from(jet),
            fire: 0,
            turn,
            pitch: 0.0,
        })
    }

    /// Asks all forms in both arithmetics, and lanes.
    ///
    /// # Errors
    /// Says what did not hold.
    pub fn check(&self) -> Result<(), String> {
        let terrain = self.terrain();
        let maps = Maps::new(core::slice::from_ref(&terrain)).map_err(|e| e.0)?;
        self.form::<Sliced, f32>(&maps, true)?;
        self.form::<Sliced, f64>(&maps, true)?;
        self.form::<Fast, f32>(&maps, true)?;
        self.form::<Fast, f64>(&maps, true)?;
        // The unswept fix-up dips and recovers, and the other two fall through creases: core/docs/tiers.md.
        self.form::<Swept, f32>(&maps, self.switches[2])?;
        self.form::<Swept, f64>(&maps, self.switches[2])?;
        self.form::<Engine, f32>(&maps, false)?;
        self.form::<Engine, f64>(&maps, false)?;
        self.form::<Anyway, f32>(&maps, false)?;
        self.form::<Anyway, f64>(&maps, false)?;
        ["authentic", "swept", "fast"].into_iter().try_for_each(|tier| self.lanes(&terrain, tier))
    }

    /// A player where the case begins, on the ground or above it.
    fn player<T: Scalar>(&self, maps: &Maps, rules: &Rules<T>) -> Body<T> {
        let t = T::from_f64;
        let surface = maps.surface::<T>();
        let [x, y] = self.place.map(|squares| t(squares * self.square));
        let (x, y, tile_x, tile_y) = surface.wrap::<T>(x, y, 0, 0);
        let ground = surface.ground::<T>(0, x, y);
        let under = if ground.exists { ground.height } else { T::zero() };
        let mut p = Player::new(rules, V3::new(x, y, under + t(self.above)), 0);
        (p.tile_x, p.tile_y) = (tile_x, tile_y);
        p.velocity = V3::new(t(self.velocity[0]), t(self.velocity[1]), t(self.velocity[2]));
        p.yaw = t(self.yaw);
        (p.touched, p.friction) = (self.touched, t(self.friction));
        p.energy = Has(t(self.energy) * rules.max_energy);
        let mut contact = p.contact();
        contact.age = self.jump_age;
        p.contact = Has(contact);
        p
    }

    fn form<M: Movement, T: Scalar>(&self, maps: &Maps, held: bool) -> Result<(), String> {
        let rules = Rules::<T>::new(M::MODEL, ARMORS[self.armor], self.pack, self.tick_ms, self.physics());
        let surface = maps.surface::<T>();
        let play = |p: &Body<T>, raw: &RawInput| {
            let mut q = tick::<Sandbox, M, T, _>(p, &input(raw), &surface, &rules);
            (q.position.x, q.position.y, q.tile_x, q.tile_y) =
                surface.wrap::<T>(q.position.x, q.position.y, q.tile_x, q.tile_y);
            q
        };
        let mut p = self.player(maps, &rules);
        // Who leaves a map with nothing behind it may come back below it.
        let mut outside = !surface.ground::<T>(0, p.position.x, p.position.y).exists;
        for (k, raw) in self.inputs().enumerate() {
            let q = play(&p, &raw);
            let what = |sentence: String| {
                let (form, real) = (core::any::type_name::<M>(), core::any::type_name::<T>());
                format!("{form} in {real}, tick {k}: {sentence}\n{raw:?}\n{p:?}\n{q:?}")
            };
            let numbers = numbers(&q);
            if numbers.iter().any(|x| !x.is_finite()) {
                return Err(what("a number that is none".into()));
            }
            if bits(&play(&p, &raw)) != bits(&q) {
                return Err(what("other bits when repeated".into()));
            }
            possible(&p, &q, &rules).map_err(&what)?;
            let (before, after) = (speed(&p), speed(&q));
            let gain = most_gained(&rules);
            let eps = if T::DOUBLE { f64::EPSILON } else { f64::from(f32::EPSILON) };
            if after > before * (1.0 + 16.0 * eps) + gain * (1.0 + 1e-5) {
                return Err(what(format!("{before} m/s became {after}, at most {gain} more are possible")));
            }
            let ground = surface.ground::<T>(0, q.position.x, q.position.y);
            outside |= !ground.exists;
            if held && !outside {
                let up = ground.normal().z.to_f64();
                let deep = (ground.height.to_f64() - q.position.z.to_f64()) * up;
                let way = (before + gain) * rules.dt.to_f64();
                let beside = (1.0 - up * up).max(0.0).sqrt();
                let place = q.position.x.to_f64().hypot(q.position.y.to_f64());
                let across = place * beside + q.position.z.to_f64().abs() * up;
                let least = if T::DOUBLE { 1e-9 } else { 2e-3 };
                // Who slides along a face is rounded anew by every slice of a metre, towards it at worst.
                let rounding = 8.0 * eps * (across + way) + 0.5 * eps * across * way.ceil();
                if deep > least + rounding {
                    return Err(what(format!("{deep} m through a face")));
                }
            }
            p = q;
        }
        Ok(())
    }

    /// As many players side by side as there are lanes have the bits of one alone.
    fn lanes(&self, terrain: &Heightfield, fidelity: &str) -> Result<(), String> {
        let setup = SimulatorSetup {
            terrain,
            solids: None,
            players: 5,
            players_per_world: 1,
            scene: "sandbox",
            armor: ARMORS[self.armor].name,
            energy_pack: self.pack,
            weapon: "disc",
            ammo: None,
            fidelity,
            precision: None,
            physics: self.physics(),
            tick_ms: self.tick_ms,
            threads: Some(1),
            lanes: Some(1),
        };
        let mut one = setup.build().map_err(|e| e.0)?;
        let speed = self.velocity;
        spread(&mut *one, speed);
        let widths: Vec<_> = crate::widths().filter(|&width| width <= 16).collect();
        let mut others = Vec::new();
        for width in widths {
            let mut sim = SimulatorSetup { lanes: Some(width), ..setup }.build().map_err(|e| e.0)?;
            spread(&mut *sim, speed);
            others.push(sim);
        }
        for (k, raw) in self.inputs().enumerate() {
            let inputs = [raw; 5];
            one.step(&inputs, 1).map_err(|e| e.0)?;
            for sim in &mut others {
                sim.step(&inputs, 1).map_err(|e| e.0)?;
                if sim.snapshot() != one.snapshot() {
                    return Err(format!("{fidelity}, tick {k}: {} lanes differ from one", sim.lanes()));
                }
            }
        }
        Ok(())
    }
}

/// Five players from the middle of the map, each at another share of a velocity.
fn spread(sim: &mut dyn Bodies, velocity: [f64; 3]) {
    let stride = sim.state_bytes();
    let mut states = sim.state();
    for k in 0..sim.len() {
        for (axis, metres) in velocity.iter().enumerate() {
            let part = (metres * (1.0 - 0.3 * k as f64)).clamp(-1e6, 1e6) as f32;
            let at = k * stride + 24 + 4 * axis;
            states[at..at + 4].copy_from_slice(&part.to_le_bytes());
        }
    }
    let everybody: Vec<_> = (0..sim.len()).collect();
    sim.set_state(&everybody, &states).expect("possible states");
}

fn input<T: Scalar>(raw: &RawInput) -> discjump_core::input::Input<T> {
    discjump_core::input::Input {
        forward: T::from_f64(f64::from(raw.forward)),
        strafe: T::from_f64(f64::from(raw.strafe)),
        jump: raw.jump != 0,
        jet: raw.jet != 0,
        turn: T::from_f64(raw.turn),
        ..discjump_core::input::Input::idle()
    }
}

/// Most that a tick adds to a speed, m/s: jump, jets, gravity and walking whichever way they point, and the
/// outward push of four contacts.
fn most_gained<T: Scalar>(rules: &Rules<T>) -> f64 {
    let forces = rules.jump.to_f64() + rules.jet.to_f64() + rules.grip.to_f64() - rules.fall.to_f64();
    forces + 4.0 * 0.001 + 1e-4
}

fn speed<T: Scalar>(p: &Body<T>) -> f64 {
    let v = [p.velocity.x, p.velocity.y, p.velocity.z].map(Scalar::to_f64);
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn numbers<T: Scalar>(p: &Body<T>) -> Vec<f64> {
    let (Has(contact), Has(energy), Has(damage)) = (p.contact, p.energy, p.damage);
    let (x, v, n) = (p.position, p.velocity, contact.normal);
    let all = [x.x, x.y, x.z, v.x, v.y, v.z, n.x, n.y, n.z, p.yaw, p.pitch, p.friction, energy, damage];
    all.map(Scalar::to_f64).to_vec()
}

fn bits<T: Scalar>(p: &Body<T>) -> Vec<u64> {
    let whole = [p.tile_x, p.tile_y, p.contact.0.age, p.bump_limits.0].map(|k| k as u64);
    let flags = [p.touched, p.crawled, p.jetting.0].map(u64::from);
    numbers(p).into_iter().map(f64::to_bits).chain(whole).chain(flags).collect()
}

/// Bounds of a state after a tick.
fn possible<T: Scalar>(before: &Body<T>, after: &Body<T>, rules: &Rules<T>) -> Result<(), String> {
    let (Has(energy), Has(damage), Has(old)) = (after.energy, after.damage, before.damage);
    let step = if rules.fresh_age == discjump_core::armor::ENGINE_FRESH_AGE { 1 } else { rules.tick_ms };
    let grace = if step == 1 && rules.tick_ms != 1 { 8 } else { 256 };
    let age = after.contact.0.age;
    let all = [
        ("energy", (T::zero()..=rules.max_energy).contains(&energy)),
        ("damage", damage >= old),
        ("friction", (0.0..=1.0).contains(&after.friction.to_f64())),
        ("yaw", after.yaw.to_f64().abs() <= core::f64::consts::PI + 1e-6),
        ("age", (0..=before.contact.0.age.max(grace) + step).contains(&age)),
        ("bump limits", (0..=1).contains(&(after.bump_limits.0 - before.bump_limits.0))),
    ];
    match all.iter().find(|(_, holds)| !holds) {
        Some((name, _)) => Err(format!("{name} out of bounds")),
        None => Ok(()),
    }
}
