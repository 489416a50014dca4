//! Columns that few environments have something to say in: zero elsewhere, with gymnasium's `_key` masks.

use super::info::Value;
use crate::arrays::{Column, Lent};
use discjump_core::task::Outcome;
use numpy::Element;
use numpy::ndarray::Ix1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

/// The masks of a key.
pub(super) struct Mask {
    key: Py<PyString>,
    buffers: Column<bool>,
}

impl Mask {
    /// Masks of `key` for `n` environments.
    pub(super) fn new(py: Python<'_>, key: &str, n: usize) -> Self {
        Self { key: PyString::intern(py, &format!("_{key}")).unbind(), buffers: Column::new(Ix1(n)) }
    }

    /// The key of the mask itself.
    pub(super) fn key<'py>(&self, py: Python<'py>) -> &Bound<'py, PyString> {
        self.key.bind(py)
    }

    /// One to write.
    pub(super) fn take<'py>(&mut self, py: Python<'py>) -> Lent<'py, bool, Ix1> {
        self.buffers.take(py)
    }

    /// One that is true where an episode ended.
    pub(super) fn of_ended<'py>(
        &mut self,
        py: Python<'py>,
        ended: &[(usize, Outcome)],
    ) -> Lent<'py, bool, Ix1> {
        spread(py, &mut self.buffers, ended, |_| true)
    }
}

/// A column of ended episodes.
pub(super) struct Spread {
    key: Py<PyString>,
    value: Value,
    mask: Mask,
    reals: Column<f64>,
    counts: Column<i64>,
    flags: Column<bool>,
}

impl Spread {
    /// The column `key` for `n` environments. No buffer is made before its first use.
    pub(super) fn new(py: Python<'_>, key: &str, value: Value, n: usize) -> Self {
        Self {
            key: PyString::intern(py, key).unbind(),
            value,
            mask: Mask::new(py, key, n),
            reals: Column::new(Ix1(n)),
            counts: Column::new(Ix1(n)),
            flags: Column::new(Ix1(n)),
        }
    }

    /// Its key.
    pub(super) fn key<'py>(&self, py: Python<'py>) -> &Bound<'py, PyString> {
        self.key.bind(py)
    }

    /// What is in it.
    pub(super) fn value(&self) -> Value {
        self.value
    }

    /// Puts column and mask of the episodes that ended into `info`.
    pub(super) fn put(&mut self, info: &Bound<'_, PyDict>, ended: &[(usize, Outcome)]) -> PyResult<()> {
        let py = info.py();
        let key = self.key.bind(py);
        match self.value {
            Value::Real(of) => info.set_item(key, spread(py, &mut self.reals, ended, of).hand_over())?,
            Value::Count(of) => info.set_item(key, spread(py, &mut self.counts, ended, of).hand_over())?,
            Value::Flag(of) => info.set_item(key, spread(py, &mut self.flags, ended, of).hand_over())?,
        }
        let mask = self.mask.of_ended(py, ended).hand_over();
        info.set_item(self.mask.key(py), mask)
    }
}

fn spread<'py, T: Element + Copy + Default>(
    py: Python<'py>,
    buffers: &mut Column<T>,
    ended: &[(usize, Outcome)],
    of: impl Fn(&Outcome) -> T,
) -> Lent<'py, T, Ix1> {
    let mut column = buffers.take_filled(py, T::default());
    let entries = column.contents();
    ended.iter().for_each(|(env, outcome)| entries[*env] = of(outcome));
    column
}
