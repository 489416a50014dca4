//! Pools of maps, shared: environments made one by one on the same terrains keep one copy of the heights.

use crate::errors::refused;
use discjump_core::terrain::{Heightfield, Maps};
use pyo3::PyResult;
use std::sync::{Arc, Mutex, Weak};

/// Pools in use, by the digests of their terrains.
static POOLS: Mutex<Vec<(Vec<String>, Weak<Maps>)>> = Mutex::new(Vec::new());

/// The pool of these terrains: one that is in use already, or a new one.
///
/// # Errors
/// If there is no terrain or their grids differ.
pub fn pool(terrains: &[&Heightfield]) -> PyResult<Arc<Maps>> {
    let key: Vec<String> = terrains.iter().map(|t| t.digest()).collect();
    let make = || {
        let fields: Vec<Heightfield> = terrains.iter().map(|&t| t.clone()).collect();
        Maps::new(&fields).map(Arc::new).map_err(refused)
    };
    // A process forked while another thread was in here finds the lock taken for ever: then do not share.
    let Ok(mut pools) = POOLS.try_lock() else { return make() };
    pools.retain(|(_, maps)| maps.strong_count() > 0);
    if let Some(maps) = pools.iter().find(|(k, _)| *k == key).and_then(|(_, maps)| maps.upgrade()) {
        return Ok(maps);
    }
    let maps = make()?;
    pools.push((key, Arc::downgrade(&maps)));
    Ok(maps)
}
