//! numpy arrays in and out.
//!
//! The contract on returned arrays: a buffer is used again only when Python holds no reference to it
//! or to a view of it any more, which its own reference count says, since every view keeps its owner
//! alive. So nothing is copied, and nothing that a user stored ever changes.

use numpy::ndarray::{Dimension, Ix1};
use numpy::npyffi::flags::{
    NPY_ARRAY_ALIGNED, NPY_ARRAY_C_CONTIGUOUS, NPY_ARRAY_OWNDATA, NPY_ARRAY_WRITEABLE,
};
use numpy::{
    Element, PyArray, PyArray1, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyList};

/// Buffers of one shape, lent to Python one at a time.
pub struct Buffers<T, D> {
    shape: D,
    lent: Vec<Py<PyArray<T, D>>>,
}

/// Beyond this many the oldest is left to Python: a user who stores every observation owns them all.
const KEPT: usize = 4;

impl<T: Element + Clone, D: Dimension> Buffers<T, D> {
    /// Buffers of a shape; none is made yet.
    pub fn new(shape: D) -> Self {
        Self { shape, lent: Vec::new() }
    }

    /// A buffer that nobody else holds. What it contains is unspecified (zeros when new).
    pub fn take<'py>(&mut self, py: Python<'py>) -> Lent<'py, T, D> {
        let array =
            self.free(py).unwrap_or_else(|| PyArray::<T, D>::zeros(py, self.shape.clone(), false).unbind());
        if self.lent.len() == KEPT {
            self.lent.remove(0);
        }
        self.lent.push(array.clone_ref(py));
        Lent(array.into_bound(py))
    }

    /// A buffer that came back as it went out. Whoever held one may have given it another dtype or shape, or
    /// made it read-only: such a one is left to Python.
    fn free(&mut self, py: Python<'_>) -> Option<Py<PyArray<T, D>>> {
        let mut at = 0;
        while at < self.lent.len() {
            if reference_count(&self.lent[at]) > 1 {
                at += 1;
                continue;
            }
            let array = self.lent.remove(at);
            if self.as_made(array.bind(py)) {
                return Some(array);
            }
        }
        None
    }

    fn as_made(&self, array: &Bound<'_, PyArray<T, D>>) -> bool {
        const MADE: i32 =
            NPY_ARRAY_C_CONTIGUOUS | NPY_ARRAY_OWNDATA | NPY_ARRAY_ALIGNED | NPY_ARRAY_WRITEABLE;
        // SAFETY: the pointer is alive while `array` is.
        let flags = unsafe { (*array.as_array_ptr()).fields.flags };
        let dtype = array.dtype().is_equiv_to(&numpy::dtype::<T>(array.py()));
        (flags & MADE) == MADE && array.shape() == self.shape.slice() && dtype
    }

    /// The same, every entry `value`.
    pub fn take_filled<'py>(&mut self, py: Python<'py>, value: T) -> Lent<'py, T, D> {
        let mut array = self.take(py);
        array.contents().fill(value);
        array
    }
}

/// A buffer on its way out: until it is handed over, Python code cannot reach it.
pub struct Lent<'py, T, D>(Bound<'py, PyArray<T, D>>);

impl<'py, T: Element, D: Dimension> Lent<'py, T, D> {
    /// Its entries, row by row.
    pub fn contents(&mut self) -> &mut [T] {
        // SAFETY: `take` found it as it was made and without another holder but the list it is kept in, and
        // it is not handed over yet. rust-numpy's own check costs more than a short step.
        unsafe { self.0.as_slice_mut().expect("buffers are contiguous") }
    }

    /// Hands it over.
    pub fn hand_over(self) -> Bound<'py, PyArray<T, D>> {
        self.0
    }
}

fn reference_count<T>(array: &Py<T>) -> isize {
    // SAFETY: the pointer is alive while `array` is.
    unsafe { pyo3::ffi::Py_REFCNT(array.as_ptr()) }
}

/// A packed structured array over bytes. `fields` are (name, numpy type code, count).
pub fn structured<'py>(
    py: Python<'py>,
    fields: &[(&str, &str, usize)],
    bytes: &[u8],
) -> PyResult<Bound<'py, PyAny>> {
    let dtype = dtype(py, fields)?;
    py.import("numpy")?.call_method1("frombuffer", (PyByteArray::new(py, bytes), dtype))
}

/// A packed structured dtype.
pub fn dtype<'py>(py: Python<'py>, fields: &[(&str, &str, usize)]) -> PyResult<Bound<'py, PyAny>> {
    let list = PyList::empty(py);
    for &(name, code, count) in fields {
        if count == 1 {
            list.append((name, code))?;
        } else {
            list.append((name, code, (count,)))?;
        }
    }
    py.import("numpy")?.call_method1("dtype", (list,))
}

/// A contiguous copy of `(n, columns)` numbers as f64.
pub fn rows(
    py: Python<'_>,
    name: &str,
    value: &Bound<'_, PyAny>,
    columns: &[usize],
) -> PyResult<(Vec<f64>, usize)> {
    let array = as_float64(py, name, value)?;
    let shape: Vec<usize> = array.getattr("shape")?.extract()?;
    let fits = shape.len() == 2 && columns.contains(&shape[1]);
    if !fits {
        let wanted: Vec<String> = columns.iter().map(|c| format!("(n, {c})")).collect();
        return Err(PyValueError::new_err(format!(
            "{name}: expected shape {}, got {shape:?}",
            wanted.join(" or ")
        )));
    }
    let array: PyReadonlyArray2<'_, f64> = array.extract()?;
    Ok((array.as_slice()?.to_vec(), shape[1]))
}

/// Real numbers as a C-contiguous, aligned float64 array.
pub fn as_float64<'py>(
    py: Python<'py>,
    name: &str,
    value: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (value,)).map_err(|e| {
        if e.is_instance_of::<PyValueError>(py) {
            PyValueError::new_err(format!(
                "{name}: expected real numbers in rows of one length, got a ragged sequence"
            ))
        } else {
            e
        }
    })?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    if !["f", "i", "u"].contains(&kind.as_str()) {
        let dtype = array.getattr("dtype")?.str()?.to_string();
        return Err(PyTypeError::new_err(format!("{name}: expected real numbers, got dtype {dtype}")));
    }
    // Aligned as well: a field of a structured array may be contiguous and lie anywhere.
    numpy.call_method1("require", (array, "float64", ["C_CONTIGUOUS", "ALIGNED"]))
}

/// Buffers of one entry per environment.
pub type Column<T> = Buffers<T, Ix1>;

/// A one-dimensional array from a vector.
pub fn array1<'py, T: Element>(py: Python<'py>, values: Vec<T>) -> Bound<'py, PyArray1<T>> {
    PyArray1::from_vec(py, values)
}
