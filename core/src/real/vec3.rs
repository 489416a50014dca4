//! Three [`Real`]s: x east, y north, z up.

use super::Real;
use core::ops::{Add, Mul, Neg, Sub};

/// A vector or a point of the kernel. `glam` serves the scalar world around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct V3<R> {
    /// East.
    pub x: R,
    /// North.
    pub y: R,
    /// Up.
    pub z: R,
}

impl<R: Real> V3<R> {
    /// From its components.
    #[inline(always)]
    pub fn new(x: R, y: R, z: R) -> Self {
        Self { x, y, z }
    }

    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(v: V3<R::Scalar>) -> Self {
        Self::new(R::splat(v.x), R::splat(v.y), R::splat(v.z))
    }

    /// The zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::new(R::zero(), R::zero(), R::zero())
    }

    /// Straight up, length 1.
    #[inline(always)]
    pub fn up() -> Self {
        Self::new(R::zero(), R::zero(), R::lit(1.0))
    }

    /// Inner product, summed from x to z.
    #[inline(always)]
    pub fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Euclidean length.
    #[inline(always)]
    pub fn length(self) -> R {
        self.dot(self).sqrt()
    }

    /// `a` where the mask is set, `b` elsewhere.
    #[inline(always)]
    pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        Self::new(R::select(mask, a.x, b.x), R::select(mask, a.y, b.y), R::select(mask, a.z, b.z))
    }

    /// One lane.
    #[inline(always)]
    pub fn lane(self, lane: usize) -> V3<R::Scalar> {
        V3 { x: self.x.lane(lane), y: self.y.lane(lane), z: self.z.lane(lane) }
    }

    /// Overwrites one lane.
    #[inline(always)]
    pub fn set_lane(&mut self, lane: usize, v: V3<R::Scalar>) {
        self.x.set_lane(lane, v.x);
        self.y.set_lane(lane, v.y);
        self.z.set_lane(lane, v.z);
    }

    /// Copies one lane of another vector, from memory to memory.
    #[inline(always)]
    pub fn copy_lane(&mut self, lane: usize, from: &Self, there: usize) {
        self.x.copy_lane(lane, &from.x, there);
        self.y.copy_lane(lane, &from.y, there);
        self.z.copy_lane(lane, &from.z, there);
    }
}

impl<R: Real> Add for V3<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl<R: Real> Sub for V3<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl<R: Real> Mul<R> for V3<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: R) -> Self {
        Self::new(self.x * k, self.y * k, self.z * k)
    }
}

impl<R: Real> Neg for V3<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}
