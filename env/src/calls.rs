//! Calls into the simulator: one at a time on one object, away from the interpreter's lock where they may be
//! long, answering Ctrl-C, and never a panic into Python.

use crate::errors::{refused, unusable};
use discjump_core::error::InputError;
use pyo3::PyClass;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::False;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// A call looks at pending signals for the first time after this long: shorter ones always come to their end.
const PATIENCE: Duration = Duration::from_millis(50);
/// And again after each of these.
const INTERVAL: Duration = Duration::from_millis(20);

/// The object, for a call that changes it.
///
/// # Errors
/// RuntimeError: another thread is in the middle of a call on it, or was when this process was forked.
pub fn exclusive<'py, T: PyClass<Frozen = False>>(object: &Bound<'py, T>) -> PyResult<PyRefMut<'py, T>> {
    object.try_borrow_mut().map_err(|_| busy())
}

/// The object, for a call that only reads it.
///
/// # Errors
/// As [`exclusive`].
pub fn shared<'py, T: PyClass>(object: &Bound<'py, T>) -> PyResult<PyRef<'py, T>> {
    object.try_borrow().map_err(|_| busy())
}

fn busy() -> PyErr {
    PyRuntimeError::new_err(
        "expected one call at a time, got one while another thread, or what a signal interrupted, is in the \
         middle of another on the same object (or was when this process was forked): give each an object of its \
         own",
    )
}

/// What can be stepped, and may have been left half-way.
pub trait Stepped: PyClass<Frozen = False> {
    /// Whether no step ended half-way.
    ///
    /// # Errors
    /// If one did.
    fn whole(&self) -> Result<(), InputError>;
}

/// The object, for a call that reads what was played.
///
/// # Errors
/// As [`exclusive`]; and RuntimeError: a step ended half-way.
pub fn reading<'py, T: Stepped>(object: &Bound<'py, T>) -> PyResult<PyRef<'py, T>> {
    let this = shared(object)?;
    this.whole().map_err(unusable)?;
    Ok(this)
}

/// The object, for a call that goes on from what was played.
///
/// # Errors
/// As [`reading`].
pub fn changing<'py, T: Stepped>(object: &Bound<'py, T>) -> PyResult<PyRefMut<'py, T>> {
    let this = exclusive(object)?;
    this.whole().map_err(unusable)?;
    Ok(this)
}

/// A short call, with the interpreter's lock held.
///
/// # Errors
/// ValueError: refused. RuntimeError: it panicked, which is a defect of ours.
pub fn here<T>(call: impl FnOnce() -> Result<T, InputError>) -> PyResult<T> {
    settled(catch_unwind(AssertUnwindSafe(call)))
}

/// A call that may be long, without the interpreter's lock. It must ask what it is given now and then, on
/// this thread, and end when the answer is no.
///
/// # Errors
/// As [`here`]; and whatever a signal's handler raised, KeyboardInterrupt by default.
pub fn away<T: Send>(
    py: Python<'_>,
    call: impl FnOnce(&mut dyn FnMut() -> bool) -> Result<T, InputError> + Send,
) -> PyResult<T> {
    let mut raised = None;
    let ended = py.detach(|| {
        let mut next = Instant::now() + PATIENCE;
        let mut go_on = || {
            let now = Instant::now();
            if now < next {
                return true;
            }
            next = now + INTERVAL;
            match Python::try_attach(|py| py.check_signals()) {
                Some(Ok(())) => true,
                Some(Err(error)) => {
                    raised = Some(error);
                    false
                }
                // The interpreter is on its way out: nobody will ask what came of this.
                None => false,
            }
        };
        catch_unwind(AssertUnwindSafe(|| call(&mut go_on)))
    });
    raised.map_or_else(|| settled(ended), Err)
}

fn settled<T>(ended: std::thread::Result<Result<T, InputError>>) -> PyResult<T> {
    match ended {
        Ok(result) => result.map_err(refused),
        Err(panic) => {
            let words = panic.downcast_ref::<String>().map(String::as_str);
            let words = words.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
            Err(PyRuntimeError::new_err(format!("a defect of discjump ended this call half-way: {words}")))
        }
    }
}
