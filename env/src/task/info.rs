//! `info`: its keys, and dictionaries of columns (one entry per environment) or of single numbers.

use super::columns::{Mask, Spread};
use crate::arrays::{Column, Lent};
use discjump_core::batch::{Environments, Status, StatusOutput};
use discjump_core::task::{Grounds, Outcome};
use numpy::ndarray::Ix1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

/// How a value is read off the end of an episode.
#[derive(Clone, Copy)]
pub(super) enum Value {
    Real(fn(&Outcome) -> f64),
    Count(fn(&Outcome) -> i64),
    Flag(fn(&Outcome) -> bool),
}

/// What every step says.
const STEP: [(&str, Value); 4] = [
    ("distance", Value::Real(|o| o.distance)),
    ("speed", Value::Real(|o| o.speed)),
    ("time", Value::Real(|o| o.time)),
    ("outside_mission_area", Value::Flag(|o| o.outside)),
];

/// What the end of an episode adds.
const END: [(&str, Value); 10] = [
    ("is_success", Value::Flag(|o| o.success)),
    ("death", Value::Flag(|o| o.death)),
    ("timeout", Value::Flag(|o| o.timeout)),
    ("return", Value::Real(|o| o.total_reward)),
    ("length", Value::Count(|o| o.length)),
    ("top_speed", Value::Real(|o| o.top_speed)),
    ("mean_speed", Value::Real(|o| o.mean_speed)),
    ("path", Value::Real(|o| o.path)),
    ("damage", Value::Real(|o| o.damage)),
    ("start_distance", Value::Real(|o| o.start_distance)),
];

/// What the end of an episode adds on some grounds, with so many levels.
pub(super) fn columns(grounds: Grounds, levels: usize) -> Vec<(&'static str, Value)> {
    let mut columns = END.to_vec();
    match grounds {
        Grounds::Beacon => {}
        Grounds::Marker => columns.push(("marker_height", Value::Real(|o| o.rise))),
        Grounds::Stands => {
            columns.push(("carrying", Value::Flag(|o| o.carried)));
            columns.push(("flags_taken", Value::Count(|o| o.taken)));
        }
    }
    if levels > 1 {
        columns.push(("level", Value::Count(|o| o.level)));
    }
    columns
}

/// The infos of a batch.
pub(super) struct Infos {
    /// A key for each of [`STEP`].
    keys: [Py<PyString>; 4],
    /// Columns of [`STEP`] for every environment, with nothing in the columns and their masks in place.
    blank: Py<PyDict>,
    distance: Column<f64>,
    speed: Column<f64>,
    time: Column<f64>,
    outside: Column<bool>,
    masks: [Mask; 4],
    /// Columns of ended episodes: of [`STEP`], then of its end.
    spreads: Vec<Spread>,
}

/// Columns of [`STEP`] that are being written.
pub(super) struct Now<'py> {
    distance: Lent<'py, f64, Ix1>,
    speed: Lent<'py, f64, Ix1>,
    time: Lent<'py, f64, Ix1>,
    outside: Lent<'py, bool, Ix1>,
}

impl Now<'_> {
    /// Where a step writes them.
    pub(super) fn output(&mut self) -> StatusOutput<'_> {
        StatusOutput {
            distance: self.distance.contents(),
            speed: self.speed.contents(),
            time: self.time.contents(),
            outside: self.outside.contents(),
        }
    }
}

impl Infos {
    /// Infos of `n` environments, with what the end of an episode adds.
    ///
    /// # Errors
    /// If numpy fails.
    pub(super) fn new(py: Python<'_>, n: usize, ends: &[(&'static str, Value)]) -> PyResult<Self> {
        let shape = Ix1(n);
        // One for all keys of all steps, so it refuses to be changed.
        let everyone = numpy::PyArray1::from_vec(py, vec![true; n]);
        everyone.call_method1("setflags", (false,))?;
        let masks = STEP.map(|(key, _)| Mask::new(py, key, n));
        let keys = STEP.map(|(key, _)| PyString::intern(py, key).unbind());
        let blank = PyDict::new(py);
        for (key, mask) in keys.iter().zip(&masks) {
            blank.set_item(key, py.None())?;
            blank.set_item(mask.key(py), &everyone)?;
        }
        let spreads = STEP.iter().chain(ends).map(|&(key, value)| Spread::new(py, key, value, n)).collect();
        Ok(Self {
            keys,
            blank: blank.unbind(),
            distance: Column::new(shape),
            speed: Column::new(shape),
            time: Column::new(shape),
            outside: Column::new(shape),
            masks,
            spreads,
        })
    }

    /// Columns to write.
    pub(super) fn take<'py>(&mut self, py: Python<'py>) -> Now<'py> {
        Now {
            distance: self.distance.take(py),
            speed: self.speed.take(py),
            time: self.time.take(py),
            outside: self.outside.take(py),
        }
    }

    /// Written columns with masks that are true everywhere.
    pub(super) fn everyone<'py>(&self, py: Python<'py>, now: Now<'py>) -> PyResult<Bound<'py, PyDict>> {
        let info = self.blank.bind(py).copy()?;
        let [distance, speed, time, outside] = self.keys.each_ref().map(|key| key.bind(py));
        info.set_item(distance, now.distance.hand_over())?;
        info.set_item(speed, now.speed.hand_over())?;
        info.set_item(time, now.time.hand_over())?;
        info.set_item(outside, now.outside.hand_over())?;
        Ok(info)
    }

    /// Columns of the environments in `mask`, of all where there is none, as they are now.
    pub(super) fn columns<'py>(
        &mut self,
        py: Python<'py>,
        batch: &dyn Environments,
        mask: Option<&[bool]>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mut now = self.take(py);
        let out = now.output();
        if mask.is_some() {
            [&mut *out.distance, &mut *out.speed, &mut *out.time]
                .into_iter()
                .for_each(|column| column.fill(0.0));
            out.outside.fill(false);
        }
        let mut put = |env: usize, s: Status| {
            (out.distance[env], out.speed[env]) = (s.distance, s.speed);
            (out.time[env], out.outside[env]) = (s.time, s.outside);
        };
        let Some(mask) = mask else {
            batch.status().into_iter().enumerate().for_each(|(env, status)| put(env, status));
            return self.everyone(py, now);
        };
        let chosen = (0..mask.len()).filter(|&env| mask[env]);
        chosen.for_each(|env| put(env, batch.status_of(env)));
        let info = self.everyone(py, now)?;
        for own in &mut self.masks {
            let mut array = own.take(py);
            array.contents().copy_from_slice(mask);
            info.set_item(own.key(py), array.hand_over())?;
        }
        Ok(info)
    }

    /// Adds the columns of the episodes that ended, zero elsewhere, with their masks.
    pub(super) fn add_ends(&mut self, info: &Bound<'_, PyDict>, ended: &[(usize, Outcome)]) -> PyResult<()> {
        self.spreads[STEP.len()..].iter_mut().try_for_each(|spread| spread.put(info, ended))
    }

    /// The same, and the columns of every step, as a dictionary of its own.
    pub(super) fn ends<'py>(
        &mut self,
        py: Python<'py>,
        ended: &[(usize, Outcome)],
    ) -> PyResult<Bound<'py, PyDict>> {
        let info = PyDict::new(py);
        self.spreads.iter_mut().try_for_each(|spread| spread.put(&info, ended))?;
        Ok(info)
    }

    /// An environment as it is now, in Python's own numbers.
    pub(super) fn row<'py>(&self, py: Python<'py>, status: &Status) -> PyResult<Bound<'py, PyDict>> {
        let info = PyDict::new(py);
        let [distance, speed, time, outside] = self.keys.each_ref().map(|key| key.bind(py));
        info.set_item(distance, status.distance)?;
        info.set_item(speed, status.speed)?;
        info.set_item(time, status.time)?;
        info.set_item(outside, status.outside)?;
        Ok(info)
    }

    /// How an episode ended, in Python's own numbers.
    pub(super) fn last_row<'py>(&self, py: Python<'py>, outcome: &Outcome) -> PyResult<Bound<'py, PyDict>> {
        let info = PyDict::new(py);
        for spread in &self.spreads {
            let key = spread.key(py);
            match spread.value() {
                Value::Real(of) => info.set_item(key, of(outcome))?,
                Value::Count(of) => info.set_item(key, of(outcome))?,
                Value::Flag(of) => info.set_item(key, of(outcome))?,
            }
        }
        Ok(info)
    }
}
