//! Solids in and out of Python, where one is a `discjump.Solid`.

use crate::errors::refused;
use discjump_core::solids::mission::{MissionSolids, solids as mission_solids};
use discjump_core::solids::{Placement, Shape, Solid, Solids, load};
use discjump_core::terrain::mission::Mission;
use discjump_core::terrain::{Heightfield, Maps};
use glam::{DQuat, DVec3};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// The attributes of a `discjump.Solid`.
#[derive(FromPyObject)]
struct SolidArgument {
    kind: String,
    name: String,
    points: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
    position: [f64; 3],
    rotation: [f64; 4],
    scale: f64,
}

/// The same attributes on their way out.
pub type Parts = (&'static str, String, Vec<[f64; 3]>, Vec<[u32; 3]>, [f64; 3], [f64; 4], f64);

impl SolidArgument {
    /// The solid; `number` is its place among the others.
    fn solid(self, number: usize) -> PyResult<Solid> {
        let points: Vec<DVec3> = self.points.into_iter().map(DVec3::from).collect();
        let shape = match (self.kind.as_str(), points.as_slice()) {
            ("box", &[size]) => Shape::Box { size },
            ("hull", _) => Shape::Hull { points },
            ("mesh", _) => Shape::Mesh { vertices: points, faces: self.faces },
            (kind, _) => {
                return Err(PyValueError::new_err(format!(
                    "solids[{number}].kind: expected \"box\" with one row of sides, \"hull\" or \"mesh\", got {kind:?}"
                )));
            }
        };
        let rotation = DQuat::from_array(self.rotation);
        let placement = Placement { position: self.position.into(), rotation, scale: self.scale };
        Ok(Solid::new(&self.name, shape, placement))
    }
}

/// The attributes of a solid.
fn parts(solid: &Solid) -> Parts {
    let rows = |points: &[DVec3]| points.iter().map(DVec3::to_array).collect::<Vec<_>>();
    let (kind, points, faces) = match &solid.shape {
        Shape::Box { size } => ("box", vec![size.to_array()], Vec::new()),
        Shape::Hull { points } => ("hull", rows(points), Vec::new()),
        Shape::Mesh { vertices, faces } => ("mesh", rows(vertices), faces.clone()),
    };
    let place = &solid.placement;
    (
        kind,
        solid.name.clone(),
        points,
        faces,
        place.position.to_array(),
        place.rotation.to_array(),
        place.scale,
    )
}

/// What stands on a terrain: as it was given, and built for queries.
#[derive(Clone, Default)]
pub struct Standing {
    given: Vec<Solid>,
    /// None where nothing stands.
    pub built: Option<Arc<Solids>>,
}

/// A mission's bases and bridge, and where its flags stand on them.
pub fn of_mission(mission: &Mission, maps: &Maps) -> MissionSolids {
    let surface = maps.surface::<f64>();
    mission_solids(mission, |x, y| {
        maps.to_local(DVec3::new(x, y, 0.0))
            .map_or(0.0, |(local, _)| surface.ground::<f64>(0, local.x, local.y).height)
    })
}

impl Standing {
    /// Checks and builds solids.
    pub fn new(given: Vec<Solid>, field: &Heightfield) -> PyResult<Self> {
        let built = match given.len() {
            0 => None,
            _ => Some(Arc::new(Solids::new(&given, field.grid()).map_err(refused)?)),
        };
        Ok(Self { given, built })
    }

    /// Solids of the user's: `solids`, a sequence of `discjump.Solid`.
    pub fn of(solids: &Bound<'_, PyAny>, field: &Heightfield) -> PyResult<Self> {
        let py = solids.py();
        let class = py.import("discjump.solids")?.getattr("Solid")?;
        let wrong = |what: &str, wanted: &str, got: &Bound<'_, PyAny>| {
            PyTypeError::new_err(format!("{what}: expected a {wanted}, got {}", got.get_type()))
        };
        let rows = solids.try_iter().map_err(|_| wrong("solids", "sequence of discjump.Solid", solids))?;
        let mut given = Vec::new();
        for (k, one) in rows.enumerate() {
            let one = one?;
            if !one.is_instance(&class)? {
                return Err(wrong(&format!("solids[{k}]"), "discjump.Solid", &one));
            }
            given.push(one.extract::<SolidArgument>()?.solid(k)?);
        }
        py.detach(|| Self::new(given, field))
    }

    /// The attributes of every solid.
    pub fn parts(&self) -> Vec<Parts> {
        self.given.iter().map(parts).collect()
    }
}

/// Vertices, and the vertex numbers of each face.
type Mesh = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// Vertices and faces of a mesh in a file.
#[pyfunction]
pub fn load_mesh(py: Python<'_>, path: PathBuf) -> PyResult<Mesh> {
    match py.detach(|| load::mesh(&path)).map_err(refused)? {
        Shape::Mesh { vertices, faces } => Ok((vertices.iter().map(DVec3::to_array).collect(), faces)),
        other => Err(PyValueError::new_err(format!("path: expected a mesh, got {other:?}"))),
    }
}
