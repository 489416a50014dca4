//! What this library was built for, and what it sees of the processor.

use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Version of the crates, target, profile, and features: those compiled for, and those that the processor has.
#[pyfunction]
pub fn build(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let build = PyDict::new(py);
    build.set_item("crate", env!("CARGO_PKG_VERSION"))?;
    build.set_item("architecture", std::env::consts::ARCH)?;
    build.set_item("system", std::env::consts::OS)?;
    build.set_item("pointer_bits", usize::BITS)?;
    build.set_item("little_endian", cfg!(target_endian = "little"))?;
    build.set_item("debug_assertions", cfg!(debug_assertions))?;
    build.set_item("compiled_for", compiled_for())?;
    build.set_item("cpu_features", cpu_features())?;
    Ok(build)
}

/// Features that every instruction may use.
fn compiled_for() -> Vec<&'static str> {
    [
        ("sse2", cfg!(target_feature = "sse2")),
        ("avx", cfg!(target_feature = "avx")),
        ("avx2", cfg!(target_feature = "avx2")),
        ("fma", cfg!(target_feature = "fma")),
        ("avx512f", cfg!(target_feature = "avx512f")),
        ("neon", cfg!(target_feature = "neon")),
    ]
    .into_iter()
    .filter_map(|(name, there)| there.then_some(name))
    .collect()
}

/// Features that bear on floating-point arithmetic and lanes.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn cpu_features() -> Vec<&'static str> {
    [
        ("sse2", is_x86_feature_detected!("sse2")),
        ("sse4.2", is_x86_feature_detected!("sse4.2")),
        ("avx", is_x86_feature_detected!("avx")),
        ("avx2", is_x86_feature_detected!("avx2")),
        ("fma", is_x86_feature_detected!("fma")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
        ("avx512vl", is_x86_feature_detected!("avx512vl")),
        ("avx512dq", is_x86_feature_detected!("avx512dq")),
        ("avx512bw", is_x86_feature_detected!("avx512bw")),
    ]
    .into_iter()
    .filter_map(|(name, there)| there.then_some(name))
    .collect()
}

/// Elsewhere there are no lanes that would depend on one.
#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
fn cpu_features() -> Vec<&'static str> {
    Vec::new()
}
