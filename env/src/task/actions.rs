//! Actions from numpy: read where they lie if they can be, else refused or made readable.

use discjump_core::task::{ActionKind, Actions};
use numpy::ndarray::{Dimension, Ix1, Ix2};
use numpy::{Element, PyArray, PyArrayDescrMethods, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// The actions of `n` environments in an array of shape (n, size) that can be read in place.
pub(super) fn of_batch<'a>(value: &'a Bound<'_, PyAny>, [n, size]: [usize; 2]) -> Option<Actions<'a>> {
    of_shape::<Ix2>(value, &[n, size])
}

/// The action of one environment in an array of shape (size,) that can be read in place.
pub(super) fn of_one<'a>(value: &'a Bound<'_, PyAny>, size: usize) -> Option<Actions<'a>> {
    of_shape::<Ix1>(value, &[size])
}

/// An array that [`of_batch`] reads, from whatever numpy makes an array of.
///
/// # Errors
/// If it has another dtype or shape.
pub(super) fn readable<'py>(
    value: &Bound<'py, PyAny>,
    [n, size]: [usize; 2],
    kind: ActionKind,
) -> PyResult<Bound<'py, PyAny>> {
    let numpy = value.py().import("numpy")?;
    let ragged = |_| {
        PyValueError::new_err(format!(
            "actions: expected numbers in rows of one length, shape ({n}, {size}), got a ragged sequence"
        ))
    };
    let array = numpy.call_method1("asarray", (value,)).map_err(ragged)?.cast_into::<PyUntypedArray>()?;
    let known = has_dtype::<i64>(&array)
        || has_dtype::<i32>(&array)
        || has_dtype::<i8>(&array)
        || has_dtype::<f32>(&array);
    if !known || array.ndim() != 2 {
        let wanted = match kind {
            ActionKind::MultiDiscrete => "int8, int32 or int64",
            ActionKind::Box => "float32",
        };
        let dtype = array.dtype().to_string();
        let message = format!(
            "actions: expected an array of {wanted}, shape ({n}, {size}), got {dtype} {}",
            array.getattr("shape")?
        );
        if wanted.contains(&dtype) && array.ndim() != 2 {
            return Err(PyValueError::new_err(message));
        }
        return Err(PyTypeError::new_err(message));
    }
    if array.shape() != [n, size] {
        return Err(PyValueError::new_err(format!(
            "actions: expected shape ({n}, {size}), got {:?}",
            array.shape()
        )));
    }
    numpy.call_method1("require", (array, value.py().None(), ["C_CONTIGUOUS", "ALIGNED"]))
}

fn has_dtype<T: Element>(array: &Bound<'_, PyUntypedArray>) -> bool {
    array.dtype().is_equiv_to(&numpy::dtype::<T>(array.py()))
}

fn of_shape<'a, D: Dimension + 'a>(value: &'a Bound<'_, PyAny>, shape: &[usize]) -> Option<Actions<'a>> {
    numbers::<i64, D>(value, shape)
        .map(Actions::Int64)
        .or_else(|| numbers::<i32, D>(value, shape).map(Actions::Int32))
        .or_else(|| numbers::<i8, D>(value, shape).map(Actions::Int8))
        .or_else(|| numbers::<f32, D>(value, shape).map(Actions::Float))
}

fn numbers<'a, T: Element, D: Dimension + 'a>(
    value: &'a Bound<'_, PyAny>,
    shape: &[usize],
) -> Option<&'a [T]> {
    let array = value.cast::<PyArray<T, D>>().ok()?;
    // Fortran order has a slice too, but its rows are scrambled.
    let plain = array.shape() == shape && array.is_c_contiguous() && array.is_aligned();
    // SAFETY: nothing here writes to what a user passes in. Another thread of his may, during a long step:
    // then it is open which keys are read, and all of them are bounded where they are used.
    if plain { unsafe { array.as_slice().ok() } } else { None }
}
