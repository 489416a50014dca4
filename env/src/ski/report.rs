//! What the core reports of environments, as structured arrays.

use crate::arrays::structured;
use discjump_core::batch::Status;
use discjump_core::task::Outcome;
use pyo3::prelude::*;

/// The dtype of `outcomes()`.
const OUTCOME: [(&str, &str, usize); 17] = [
    ("success", "?", 1),
    ("death", "?", 1),
    ("timeout", "?", 1),
    ("time", "<f8", 1),
    ("total_reward", "<f8", 1),
    ("length", "<i8", 1),
    ("top_speed", "<f8", 1),
    ("mean_speed", "<f8", 1),
    ("path", "<f8", 1),
    ("damage", "<f8", 1),
    ("distance", "<f8", 1),
    ("start_distance", "<f8", 1),
    ("speed", "<f8", 1),
    ("outside", "?", 1),
    ("terrain", "<i8", 1),
    ("seed", "<u8", 1),
    ("episode", "<u8", 1),
];

/// The dtype of `status()`.
const STATUS: [(&str, &str, usize); 5] = [
    ("distance", "<f8", 1),
    ("speed", "<f8", 1),
    ("time", "<f8", 1),
    ("outside", "?", 1),
    ("terrain", "<i4", 1),
];

/// How episodes ended: shape (len(ended),).
pub(super) fn outcomes<'py>(py: Python<'py>, ended: &[(usize, Outcome)]) -> PyResult<Bound<'py, PyAny>> {
    let mut bytes = Vec::new();
    for (_, o) in ended {
        bytes.extend([o.success, o.death, o.timeout].map(u8::from));
        bytes.extend(o.time.to_le_bytes());
        bytes.extend(o.total_reward.to_le_bytes());
        bytes.extend(o.length.to_le_bytes());
        for x in [o.top_speed, o.mean_speed, o.path, o.damage, o.distance, o.start_distance, o.speed] {
            bytes.extend(x.to_le_bytes());
        }
        bytes.push(u8::from(o.outside));
        bytes.extend(o.terrain.to_le_bytes());
        bytes.extend(o.seed.to_le_bytes());
        bytes.extend(o.episode.to_le_bytes());
    }
    structured(py, &OUTCOME, &bytes)
}

/// Where environments are: shape (num_envs,).
pub(super) fn status<'py>(py: Python<'py>, environments: &[Status]) -> PyResult<Bound<'py, PyAny>> {
    let mut bytes = Vec::new();
    for s in environments {
        for x in [s.distance, s.speed, s.time] {
            bytes.extend(x.to_le_bytes());
        }
        bytes.push(u8::from(s.outside));
        bytes.extend((s.terrain as i32).to_le_bytes());
    }
    structured(py, &STATUS, &bytes)
}
