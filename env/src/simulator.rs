//! `Simulator`: bodies without a task. The package wraps it; here arrays are bytes.

use crate::arrays::{dtype, rows, structured};
use crate::errors::refused;
use crate::physics::PhysicsArgument;
use crate::terrain::Terrain;
use discjump_core::batch::{Bodies, RawInput, Shot, SimulatorSetup};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Player-ticks between two looks at pending signals: some 20 ms of work.
const BURST: usize = 200_000;

/// Bytes of one input: the aligned layout of `discjump.INPUT`.
pub const INPUT_BYTES: usize = size_of::<RawInput>();

/// Private: a batch of players in one scene and tier.
#[pyclass(module = "discjump._native")]
pub struct Simulator {
    pub(crate) bodies: Box<dyn Bodies>,
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
    fn num_players(&self) -> usize {
        self.bodies.len()
    }

    /// Players stepped side by side.
    #[getter]
    fn lanes(&self) -> usize {
        self.bodies.lanes()
    }

    /// "float32" or "float64".
    #[getter]
    fn precision(&self) -> &'static str {
        self.bodies.precision()
    }

    /// The scene's name.
    #[getter]
    fn scene(&self) -> &'static str {
        self.bodies.scene()
    }

    /// Bytes that one player takes in memory.
    #[getter]
    fn player_bytes(&self) -> usize {
        self.bodies.player_bytes()
    }

    /// The structured dtype of `state()`.
    #[getter]
    fn state_dtype<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        dtype(py, &self.fields())
    }

    /// A copy of all states: structured, shape (num_players,).
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        structured(py, &self.fields(), &self.bodies.state())
    }

    /// Overwrites states, given as packed bytes of `state_dtype`.
    fn set_state(&mut self, indices: Vec<usize>, states: &[u8]) -> PyResult<()> {
        self.bodies.set_state(&indices, states).map_err(refused)
    }

    /// Plays `ticks` ticks of inputs given as bytes of `discjump.INPUT`.
    fn step(&mut self, py: Python<'_>, inputs: &[u8], ticks: u32) -> PyResult<()> {
        let inputs: Vec<RawInput> = inputs.chunks_exact(INPUT_BYTES).map(read_input).collect();
        let burst = u32::try_from(BURST / self.bodies.len().max(1)).unwrap_or(u32::MAX).max(1);
        let mut left = ticks;
        loop {
            let now = left.min(burst);
            py.detach(|| self.bodies.step(&inputs, now)).map_err(refused)?;
            left -= now;
            if left == 0 {
                return Ok(());
            }
            py.check_signals()?;
        }
    }

    /// One explosion per player at points (num_players, 3), m; NaN: none.
    fn explode(&mut self, py: Python<'_>, points: &Bound<'_, PyAny>, weapon: &str) -> PyResult<()> {
        let (points, _) = rows(py, "points", points, &[3])?;
        let points: Vec<[f64; 3]> = points.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        self.bodies.explode(&points, weapon).map_err(refused)
    }

    /// The projectiles that burst in the last tick: structured.
    fn blasts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shots(py, &self.bodies.blasts(), "normal")
    }

    /// The projectiles under way: structured.
    fn projectiles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shots(py, &self.bodies.projectiles(), "aim")
    }

    /// Everything, as bytes that `restore` takes.
    fn snapshot<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.bodies.snapshot())
    }

    /// Goes back to a snapshot of a simulator with the same terrain and arguments.
    fn restore(&mut self, snapshot: &[u8]) -> PyResult<()> {
        self.bodies.restore(snapshot).map_err(refused)
    }

    /// 32 hexadecimal digits that name the players' exact bits.
    fn digest(&self) -> String {
        self.bodies.digest()
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
