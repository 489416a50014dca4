//! Stands in for the room of solids in a build without the cargo feature `solids`: the type has no values, so
//! whatever is done with one is not compiled.

use crate::real::{Real, V3};
use glam::{DVec2, DVec3};

/// No value of it can be made.
#[derive(Clone, Copy, Debug)]
pub enum Solids {}

/// The contact that nobody has.
#[derive(Clone, Copy, Debug)]
pub struct SolidHit {
    /// Share of the path up to it.
    pub fraction: f64,
    /// Unit normal against the mover.
    pub normal: DVec3,
}

#[allow(missing_docs, reason = "they cannot be called; the room of solids has the words")]
impl Solids {
    pub fn farthest(&self, _from: DVec3) -> f64 {
        match *self {}
    }
    pub fn digest(&self) -> u128 {
        match *self {}
    }
    pub fn near(&self, _x: f64, _y: f64, _z: f64, _reach: f64) -> bool {
        match *self {}
    }
    pub(crate) fn may_be_near<R: Real>(&self, _centre: DVec2, _place: V3<R>, _reach: R) -> R::Mask {
        match *self {}
    }
    pub(crate) fn beyond<R: Real>(&self, _: DVec2, _ends: (V3<R>, V3<R>), _reach: R) -> R::Mask {
        match *self {}
    }
    pub fn sweep_box(&self, _: DVec3, _path: DVec3, _half_width: f64, _height: f64) -> Option<SolidHit> {
        match *self {}
    }
    pub fn ray(&self, _from: DVec3, _path: DVec3) -> Option<SolidHit> {
        match *self {}
    }
    pub fn step_up(
        &self,
        _feet: DVec3,
        _path: DVec3,
        _half_width: f64,
        _height: f64,
        _most: f64,
        _met: &SolidHit,
    ) -> Option<f64> {
        match *self {}
    }
}
