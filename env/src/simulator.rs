//! `Simulator`: bodies without a task. The package wraps it; here arrays are bytes.

use crate::arrays::{dtype, rows, structured};
use crate::calls::{Stepped, away, changing, exclusive, here, reading, shared};
use crate::errors::refused;
use crate::physics::PhysicsArgument;
use crate::terrain::Terrain;
use discjump_core::batch::{Bodies, RawInput, Shot, SimulatorSetup};
use discjump_core::error::InputError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::time::{Duration, Instant};

/// Player-ticks before the first look at pending signals.
const BURST: usize = 20_000;
/// Time between two looks: whole ticks are played in between, as many as take about so long.
const BETWEEN_LOOKS: Duration = Duration::from_millis(10);

/// Bytes of one input: the aligned layout of `discjump.INPUT`.
pub const INPUT_BYTES: usize = size_of::<RawInput>();

/// Private: a batch of players in one scene and tier.
#[pyclass(module = "discjump._native")]
pub struct Simulator {
    pub(crate) bodies: Box<dyn Bodies>,
}

impl Stepped for Simulator {
    fn whole(&self) -> Result<(), InputError> {
        self.bodies.whole()
    }
}

impl Simulator {
    fn fields(&self) -> Vec<(&'static str, &'static str, usize)> {
        state_fields(&self.bodies.state_fields())
    }
}

/// Names, numpy codes and counts of a state, its position first.
pub fn state_fields(fields: &[discjump_core::player::Field]) -> Vec<(&'static str, &'static str, usize)> {
    let rest = fields.iter().map(|f| (f.name, f.kind.numpy_code(), f.count));
    core::iter::once(("position", "<f8", 3)).chain(rest).collect()
}

#[pymethods]
impl Simulator {
    #[new]
    #[pyo3(signature = (terrain, num_players, players_per_world, scene, armor, energy_pack, weapon, ammo, fidelity,
        precision, physics, tick_ms, threads, lanes))]
    #[expect(clippy::too_many_arguments, reason = "the package's constructor names them")]
    fn new(
        terrain: &Terrain,
        num_players: usize,
        players_per_world: usize,
        scene: &str,
        armor: &str,
        energy_pack: bool,
        weapon: &str,
        ammo: Option<i32>,
        fidelity: &str,
        precision: Option<&str>,
        physics: PhysicsArgument,
        tick_ms: u32,
        threads: Option<usize>,
        lanes: Option<usize>,
    ) -> PyResult<Self> {
        let setup = SimulatorSetup {
            terrain: &terrain.heightfield,
            solids: terrain.solids.built.as_ref(),
            players: num_players,
            players_per_world,
            scene,
            armor,
            energy_pack,
            weapon,
            ammo,
            fidelity,
            precision,
            physics: physics.switches()?,
            tick_ms,
            threads,
            lanes,
        };
        Ok(Self { bodies: setup.build().map_err(refused)? })
    }

    /// How many players.
    #[getter]
    fn num_players(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Ok(shared(slf)?.bodies.len())
    }

    /// Players stepped side by side.
    #[getter]
    fn lanes(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Ok(shared(slf)?.bodies.lanes())
    }

    /// "float32" or "float64".
    #[getter]
    fn precision(slf: &Bound<'_, Self>) -> PyResult<&'static str> {
        Ok(shared(slf)?.bodies.precision())
    }

    /// The scene's name.
    #[getter]
    fn scene(slf: &Bound<'_, Self>) -> PyResult<&'static str> {
        Ok(shared(slf)?.bodies.scene())
    }

    /// Bytes that one player takes in memory.
    #[getter]
    fn player_bytes(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Ok(shared(slf)?.bodies.player_bytes())
    }

    /// The structured dtype of `state()`.
    #[getter]
    fn state_dtype<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        dtype(slf.py(), &shared(slf)?.fields())
    }

    /// A copy of all states: structured, shape (num_players,).
    fn state<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let this = reading(slf)?;
        structured(slf.py(), &this.fields(), &this.bodies.state())
    }

    /// Overwrites states, given as packed bytes of `state_dtype`.
    fn set_state(slf: &Bound<'_, Self>, indices: Vec<usize>, states: &[u8]) -> PyResult<()> {
        changing(slf)?.bodies.set_state(&indices, states).map_err(refused)
    }

    /// Plays `ticks` ticks of inputs given as bytes of `discjump.INPUT`.
    fn step(slf: &Bound<'_, Self>, inputs: &[u8], ticks: u32) -> PyResult<()> {
        let (py, mut this) = (slf.py(), changing(slf)?);
        let bodies = &mut this.bodies;
        let mut keys: Vec<RawInput> = Vec::with_capacity(bodies.len());
        for some in inputs.chunks(INPUT_BYTES << 18) {
            keys.extend(some.chunks_exact(INPUT_BYTES).map(read_input));
            py.check_signals()?;
        }
        let mut burst = u32::try_from(BURST / bodies.len().max(1)).unwrap_or(u32::MAX).max(1);
        let mut left = ticks;
        loop {
            let (now, began) = (left.min(burst), Instant::now());
            away(py, |go_on| bodies.step_while(&keys, now, go_on))?;
            left -= now;
            if left == 0 {
                return Ok(());
            }
            py.check_signals()?;
            let took = began.elapsed();
            if took > 2 * BETWEEN_LOOKS {
                burst = (burst / 2).max(1);
            } else if took < BETWEEN_LOOKS {
                burst = burst.saturating_mul(2);
            }
        }
    }

    /// One explosion per player at points (num_players, 3), m; NaN: none.
    fn explode(slf: &Bound<'_, Self>, points: &Bound<'_, PyAny>, weapon: &str) -> PyResult<()> {
        // Before the points, whose own code may ask for the simulator.
        reading(slf)?;
        let (points, _) = rows(slf.py(), "points", points, &[3])?;
        let points: Vec<[f64; 3]> = points.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        let mut this = changing(slf)?;
        here(|| this.bodies.explode(&points, weapon))
    }

    /// The projectiles that burst in the last tick: structured.
    fn blasts<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        shots(slf.py(), &reading(slf)?.bodies.blasts(), "normal")
    }

    /// The projectiles under way: structured.
    fn projectiles<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        shots(slf.py(), &reading(slf)?.bodies.projectiles(), "aim")
    }

    /// The contacts of a player's next tick with an input, given as bytes of `discjump.INPUT`: structured.
    fn contacts<'py>(slf: &Bound<'py, Self>, player: usize, input: &[u8]) -> PyResult<Bound<'py, PyAny>> {
        let this = reading(slf)?;
        let mut bytes = Vec::new();
        for contact in here(|| this.bodies.contacts(player, &read_input(input)))? {
            let numbers = [contact.position, contact.velocity, contact.normal];
            numbers.as_flattened().iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        }
        let fields = [("position", "<f8", 3), ("velocity", "<f8", 3), ("normal", "<f8", 3)];
        structured(slf.py(), &fields, &bytes)
    }

    /// Everything, or everything of one player, as bytes that `restore` takes.
    #[pyo3(signature = (player=None))]
    fn snapshot<'py>(slf: &Bound<'py, Self>, player: Option<usize>) -> PyResult<Bound<'py, PyBytes>> {
        let this = reading(slf)?;
        let bytes = match player {
            Some(player) => this.bodies.snapshot_one(player).map_err(refused)?,
            None => this.bodies.snapshot(),
        };
        Ok(PyBytes::new(slf.py(), &bytes))
    }

    /// Goes back to a snapshot of a simulator with the same terrain and arguments, or puts one player there.
    #[pyo3(signature = (snapshot, player=None))]
    fn restore(slf: &Bound<'_, Self>, snapshot: &[u8], player: Option<usize>) -> PyResult<()> {
        let mut this = exclusive(slf)?;
        here(|| match player {
            Some(player) => this.bodies.restore_one(player, snapshot),
            None => this.bodies.restore(snapshot),
        })
    }

    /// 32 hexadecimal digits that name the players' exact bits.
    fn digest(slf: &Bound<'_, Self>) -> PyResult<String> {
        Ok(reading(slf)?.bodies.digest())
    }

    /// Makes the next step fail half-way, as a defect would: for tests of what comes after.
    fn fail_next_step(slf: &Bound<'_, Self>) -> PyResult<()> {
        exclusive(slf)?.bodies.fail_next_step();
        Ok(())
    }
}

/// Projectiles as a structured array; `axis` names what their axis is.
fn shots<'py>(py: Python<'py>, shots: &[Shot], axis: &str) -> PyResult<Bound<'py, PyAny>> {
    let mut bytes = Vec::new();
    for shot in shots {
        bytes.extend((shot.player as i64).to_le_bytes());
        let reals = shot.position.iter().chain(&shot.velocity).chain(&shot.axis);
        reals.for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend(shot.age.to_le_bytes());
    }
    let vector = |name| (name, "<f8", 3);
    let fields =
        [("player", "<i8", 1), vector("position"), vector("velocity"), vector(axis), ("age", "<i4", 1)];
    structured(py, &fields, &bytes)
}

/// Every scene: name, what it models, what it leaves out.
#[pyfunction]
pub fn scenes() -> Vec<(&'static str, Vec<&'static str>, Vec<&'static str>)> {
    discjump_core::scene::scenes().into_iter().map(|s| (s.name, s.models, s.leaves_out)).collect()
}

/// One input from its bytes.
pub fn read_input(bytes: &[u8]) -> RawInput {
    let real = |at: usize| f64::from_le_bytes(bytes[at..at + 8].try_into().expect("8 bytes"));
    RawInput {
        forward: bytes[0].cast_signed(),
        strafe: bytes[1].cast_signed(),
        jump: bytes[2],
        jet: bytes[3],
        fire: bytes[4],
        turn: real(8),
        pitch: real(16),
    }
}
