//! `Terrain`: a heightfield, generated or the user's own.

use crate::arrays::{array1, as_float64, rows};
use crate::errors::refused;
use crate::solids::{Standing, of_mission};
use discjump_core::terrain::mission::{Area, Mission};
use discjump_core::terrain::statistics::Report;
use discjump_core::terrain::{Edge, Heightfield, Maps, SurfaceKind, raindance};
use glam::DVec3;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Name, group, value, least, greatest, whether it is inside.
type AcceptanceRow = (&'static str, String, f64, f64, f64, bool);

/// A heightfield of squares, cut into triangles in a checkerboard (`surface` "triangles", the game's) or each
/// filled by the bilinear interpolation of its corners ("bilinear").
///
/// Make one with `Terrain.raindance(seed)` or `Terrain.from_heights(heights)`. Coordinates are
/// metres, x east, y north, z up.
#[pyclass(module = "discjump", frozen)]
pub struct Terrain {
    pub heightfield: Heightfield,
    /// The same, as queries read it.
    maps: Maps,
    mission: Option<Mission>,
    /// Where the mission's flags stand on its bases.
    flag_stands: [[f64; 3]; 2],
    seed: Option<u64>,
    pub solids: Standing,
}

impl Terrain {
    fn new(heightfield: Heightfield, mission: Option<Mission>, seed: Option<u64>) -> PyResult<Self> {
        let maps = Maps::new(core::slice::from_ref(&heightfield)).map_err(refused)?;
        let (mut solids, mut flag_stands) = (Standing::default(), [[0.0; 3]; 2]);
        if let Some(mission) = &mission {
            let made = of_mission(mission, &maps);
            flag_stands = made.flags;
            solids = Standing::new(made.solids, &heightfield)?;
        }
        Ok(Self { heightfield, maps, mission, flag_stands, seed, solids })
    }

    /// The same with another surface. Mission and solids stay where they are on triangles.
    fn surfaced(&self, surface: SurfaceKind) -> PyResult<Self> {
        let heightfield = self.heightfield.clone().with_surface(surface);
        Ok(Self {
            maps: Maps::new(core::slice::from_ref(&heightfield)).map_err(refused)?,
            heightfield,
            mission: self.mission.clone(),
            flag_stands: self.flag_stands,
            seed: self.seed,
            solids: self.solids.clone(),
        })
    }

    /// Where episodes take place: the mission area, or the whole map.
    pub fn area(&self) -> Area {
        if let Some(mission) = &self.mission {
            return mission.area;
        }
        let (min, size) = (self.heightfield.origin(), self.maps.size());
        Area { min, max: [min[0] + size.x, min[1] + size.y] }
    }

    /// Where its flags stand, if it has a mission.
    pub fn flag_stands(&self) -> Option<[[f64; 3]; 2]> {
        self.mission.as_ref().map(|_| self.flag_stands)
    }

    fn report(&self) -> PyResult<Report> {
        Report::of(self.heightfield.heights(), self.mission.as_ref())
            .map_err(|e| PyValueError::new_err(e.to_string()))
    }

    /// Ground under world points, in f64.
    pub fn ground(&self, name: &str, x: f64, y: f64) -> PyResult<discjump_core::terrain::Ground<f64>> {
        let (local, _) = self
            .maps
            .to_local(DVec3::new(x, y, 0.0))
            .map_err(|e| PyValueError::new_err(format!("{name}: {e}")))?;
        Ok(self.maps.surface::<f64>().ground::<f64>(0, local.x, local.y))
    }
}

#[pymethods]
impl Terrain {
    /// Terrain like Raindance: 257 x 257 heights, 8 m apart, with two flags and a bridge over a gorge.
    ///
    /// The same seed gives the same bits everywhere. `repeating=True` lays one 512 m cell 4 x 4, as
    /// the original does. `surface` is "triangles" or "bilinear"; heights, mission and solids are the same.
    ///
    /// >>> import discjump
    /// >>> terrain = discjump.Terrain.raindance(seed=7)
    /// >>> terrain.heights.shape
    /// (257, 257)
    #[staticmethod]
    #[pyo3(signature = (seed=0, *, repeating=false, surface="triangles"))]
    fn raindance(py: Python<'_>, seed: u64, repeating: bool, surface: &str) -> PyResult<Self> {
        let surface: SurfaceKind = surface.parse().map_err(refused)?;
        let made = py
            .detach(|| raindance::generate(seed, raindance::Options { repeating }))
            .map_err(|e| PyRuntimeError::new_err(e.to_string()))?;
        let side = 257;
        let field = Heightfield::new(made.heights, side, side, 8.0, [-1024.0, -1024.0], Edge::Tile)
            .map_err(refused)?;
        let cut = Self::new(field, Some(made.mission), Some(seed))?;
        if surface == SurfaceKind::Triangles { Ok(cut) } else { cut.surfaced(surface) }
    }

    /// Terrain of the user's own heights, in metres, `heights[row y][column x]`, at least 2 x 2.
    ///
    /// `origin` is the place of `heights[0, 0]`. `edge` says what lies beyond the rim: "tile" (the map
    /// again, for ever; its last row and column repeat the first), "clamp" (the rim's heights go on) or
    /// "void" (nothing). `surface` is what lies between the heights: "triangles" or "bilinear".
    ///
    /// >>> import discjump, numpy as np
    /// >>> flat = discjump.Terrain.from_heights(np.zeros((65, 65)), edge="clamp")
    /// >>> flat.height([[3.0, 4.0]])
    /// array([0.])
    #[staticmethod]
    #[pyo3(signature = (heights, square_size=8.0, origin=(0.0, 0.0), edge="tile", surface="triangles"))]
    fn from_heights(
        py: Python<'_>,
        heights: &Bound<'_, PyAny>,
        square_size: f64,
        origin: (f64, f64),
        edge: &str,
        surface: &str,
    ) -> PyResult<Self> {
        let array = as_float64(py, "heights", heights)?;
        let shape: Vec<usize> = array.getattr("shape")?.extract()?;
        let &[rows, cols] = shape.as_slice() else {
            return Err(PyValueError::new_err(format!(
                "heights: expected shape (rows, columns), got {shape:?}"
            )));
        };
        let array: PyReadonlyArray2<'_, f64> = array.extract()?;
        let values = array.as_slice()?.to_vec();
        let edge: Edge = edge.parse().map_err(refused)?;
        let surface: SurfaceKind = surface.parse().map_err(refused)?;
        let field =
            Heightfield::new(values, rows, cols, square_size, [origin.0, origin.1], edge).map_err(refused)?;
        Self::new(field.with_surface(surface), None, None)
    }

    /// Vertex heights, float64 (rows, columns), m: a copy.
    #[getter]
    fn heights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array1(py, self.heightfield.heights().to_vec())
            .reshape([self.heightfield.rows(), self.heightfield.cols()])
    }

    /// Side of a square, m.
    #[getter]
    fn square_size(&self) -> f64 {
        self.heightfield.square_size()
    }

    /// Place of the first vertex, m.
    #[getter]
    fn origin(&self) -> (f64, f64) {
        self.heightfield.origin().into()
    }

    /// Sides of the map along x and y, m.
    #[getter]
    fn size(&self) -> (f64, f64) {
        self.maps.size().into()
    }

    /// What lies beyond the rim: "tile", "clamp" or "void".
    #[getter]
    fn edge(&self) -> &'static str {
        self.heightfield.edge().name()
    }

    /// What lies between the heights: "triangles" or "bilinear".
    #[getter]
    fn surface(&self) -> &'static str {
        self.heightfield.surface().name()
    }

    /// The same heights, mission and solids with another surface: "triangles" or "bilinear".
    ///
    /// Smoother than the game's ground and not the same: within a square slopes change gradually, but they
    /// still jump from one square to the next. A mission's flags and solids stay where they are on triangles.
    ///
    /// Raises ValueError for any other name.
    ///
    /// >>> import discjump, numpy as np
    /// >>> pyramid = discjump.Terrain.from_heights(np.diag([0.0, 8.0]), edge="clamp")
    /// >>> smooth = pyramid.with_surface("bilinear")
    /// >>> pyramid.height([[4.0, 4.0]]), smooth.height([[4.0, 4.0]])
    /// (array([4.]), array([2.]))
    fn with_surface(&self, surface: &str) -> PyResult<Self> {
        self.surfaced(surface.parse().map_err(refused)?)
    }

    /// The seed it was generated from, or None.
    #[getter]
    fn seed(&self) -> Option<u64> {
        self.seed
    }

    /// Where episodes take place: ((x, y) of the south-west corner, (x, y) of the north-east one), m.
    #[getter]
    fn play_area(&self) -> ((f64, f64), (f64, f64)) {
        let area = self.area();
        (area.min.into(), area.max.into())
    }

    /// The mission, or None: a dict of flags (2, 3) on the ground, flag_stands (2, 3) where they stand on
    /// its own bases, bridge_centre (3,), bridge_ends (2, 3), bridge_width, bridge_deck_top, area_min (2,),
    /// area_max (2,); metres.
    #[getter]
    fn mission<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(mission) = &self.mission else { return Ok(None) };
        let pair = |p: [[f64; 3]; 2]| array1(py, p.concat()).reshape([2, 3]);
        let dict = PyDict::new(py);
        dict.set_item("flags", pair(mission.flags)?)?;
        dict.set_item("flag_stands", pair(self.flag_stands)?)?;
        dict.set_item("bridge_centre", array1(py, mission.bridge.centre.to_vec()))?;
        dict.set_item("bridge_ends", pair(mission.bridge.ends)?)?;
        dict.set_item("bridge_width", mission.bridge.width)?;
        dict.set_item("bridge_deck_top", mission.bridge.deck_top)?;
        dict.set_item("area_min", array1(py, mission.area.min.to_vec()))?;
        dict.set_item("area_max", array1(py, mission.area.max.to_vec()))?;
        Ok(Some(dict))
    }

    /// What stands on it: a list of `discjump.Solid`. A generated terrain has the bases and the bridge of
    /// its mission. Only scenes that model solids look at them.
    #[getter]
    fn solids<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let class = py.import("discjump.solids")?.getattr("Solid")?;
        self.solids.parts().into_iter().map(|parts| class.call1(parts)).collect()
    }

    /// The same terrain with other solids: a sequence of `discjump.Solid`, `terrain.solids + [...]` to add.
    ///
    /// Raises ValueError, naming the solid and its face, for what is no closed body or stands outside the
    /// map; TypeError for what is no solid.
    fn with_solids(&self, solids: &Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self {
            heightfield: self.heightfield.clone(),
            maps: self.maps.clone(),
            mission: self.mission.clone(),
            flag_stands: self.flag_stands,
            seed: self.seed,
            solids: Standing::of(solids, &self.heightfield)?,
        })
    }

    /// Triangles of what stands on it, float64 (n, 3 corners, 3), m, counter-clockwise from outside.
    fn solid_faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let faces = self.solids.built.iter().flat_map(|solids| solids.faces());
        let corners: Vec<f64> =
            faces.flat_map(|(_, corners)| corners).flat_map(|corner| corner.to_array()).collect();
        let count = corners.len() / 9;
        array1(py, corners).reshape([count, 3, 3])
    }

    /// 32 hexadecimal digits that name what stands on it.
    fn solids_digest(&self) -> String {
        self.solids
            .built
            .as_ref()
            .map_or_else(|| "0".repeat(32), |solids| format!("{:032x}", solids.digest()))
    }

    /// Height of the ground at points (n, 2), float64 (n,), m; NaN where there is none.
    fn height<'py>(&self, py: Python<'py>, xy: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (points, _) = rows(py, "xy", xy, &[2])?;
        let heights: PyResult<Vec<f64>> = points
            .chunks_exact(2)
            .map(|p| {
                let ground = self.ground("xy", p[0], p[1])?;
                Ok(if ground.exists { ground.height } else { f64::NAN })
            })
            .collect();
        Ok(array1(py, heights?))
    }

    /// Unit normal of the ground at points (n, 2), float64 (n, 3); NaN where there is none.
    fn normal<'py>(&self, py: Python<'py>, xy: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (points, _) = rows(py, "xy", xy, &[2])?;
        let mut normals = Vec::with_capacity(points.len() / 2 * 3);
        for p in points.chunks_exact(2) {
            let ground = self.ground("xy", p[0], p[1])?;
            let n = ground.normal();
            normals.extend(if ground.exists { [n.x, n.y, n.z] } else { [f64::NAN; 3] });
        }
        array1(py, normals).reshape([points.len() / 2, 3])
    }

    /// Statistics by name. Needs 257 x 257 (or 256 x 256) heights; those of the mission only where
    /// there is one. They are of the heights and of triangles between them, whatever the surface.
    fn statistics(&self) -> PyResult<std::collections::BTreeMap<&'static str, f64>> {
        Ok(self.report()?.rows.iter().map(|row| (row.name, row.value)).collect())
    }

    /// The statistics beside the windows of "Raindance-like": a list of (name, group, value, least,
    /// greatest, whether it is inside).
    fn acceptance(&self) -> PyResult<Vec<AcceptanceRow>> {
        let report = self.report()?;
        let group = |row: &discjump_core::terrain::statistics::Row| format!("{:?}", row.group).to_lowercase();
        Ok(report.rows.iter().map(|r| (r.name, group(r), r.value, r.min, r.max, r.inside)).collect())
    }

    /// Whether it is Raindance-like: all core (and mission) statistics inside their windows, at most 2
    /// of the supporting ones outside, and edges that meet.
    fn is_raindance_like(&self) -> PyResult<bool> {
        let report = self.report()?;
        Ok(if self.mission.is_some() { report.passes() } else { report.passes_without_mission() })
    }

    /// 32 hexadecimal digits that name the exact bits of grid and heights, and the surface.
    fn digest(&self) -> String {
        self.heightfield.digest()
    }

    fn __repr__(&self) -> String {
        let grid = &self.heightfield;
        let made = self.seed.map_or_else(String::new, |seed| format!("raindance seed {seed}, "));
        let surface = match grid.surface() {
            SurfaceKind::Triangles => String::new(),
            other => format!(", surface \"{}\"", other.name()),
        };
        format!(
            "Terrain({made}{} x {} heights, {} m apart, edge \"{}\"{surface})",
            grid.rows(),
            grid.cols(),
            grid.square_size(),
            grid.edge().name()
        )
    }
}
