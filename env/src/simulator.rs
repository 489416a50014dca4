//! `Simulator`: bodies without a task. The package wraps it; here arrays are bytes.

use crate::arrays::{dtype, structured};
use crate::errors::refused;
use crate::terrain::Terrain;
use discjump_core::batch::{Bodies, RawInput, SimulatorSetup};
use discjump_core::rules::Physics;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Player-ticks between two looks at pending signals: some 20 ms of work.
const BURST: usize = 200_000;

/// Bytes of one input: the aligned layout of `discjump.INPUT`.
const INPUT_BYTES: usize = size_of::<RawInput>();

/// Private: a batch of players in one scene and tier.
#[pyclass(module = "discjump._native")]
pub struct Simulator {
    bodies: Box<dyn Bodies>,
}

/// The switches of a `discjump.Physics`.
pub fn physics(value: Option<(Option<bool>, bool)>) -> Physics {
    value.map_or_else(Physics::default, |(ski_bug, hysteresis)| Physics {
        ski_bug,
        hysteresis,
        ..Physics::default()
    })
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
    #[pyo3(signature = (terrain, num_players, scene, armor, energy_pack, fidelity, physics, tick_ms, threads))]
    #[expect(clippy::too_many_arguments, reason = "the package's constructor names them")]
    fn new(
        terrain: &Terrain,
        num_players: usize,
        scene: &str,
        armor: &str,
        energy_pack: bool,
        fidelity: &str,
        physics: Option<(Option<bool>, bool)>,
        tick_ms: u32,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let setup = SimulatorSetup {
            terrain: &terrain.heightfield,
            players: num_players,
            scene,
            armor,
            energy_pack,
            fidelity,
            physics: self::physics(physics),
            tick_ms,
            threads,
        };
        Ok(Self { bodies: setup.build().map_err(refused)? })
    }

    /// How many players.
    #[getter]
    fn num_players(&self) -> usize {
        self.bodies.len()
    }

    /// What the scene models.
    #[getter]
    fn models(&self) -> Vec<&'static str> {
        self.bodies.models()
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

fn read_input(bytes: &[u8]) -> RawInput {
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
