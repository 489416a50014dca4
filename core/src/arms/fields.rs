//! The list of a launcher's fields, once: snapshots, digests and structured arrays walk it.

use super::{Arms, Projectile};
use crate::player::{FieldVisitor, visit_vector};
use crate::real::Scalar;

/// Walks a launcher's fields: its own, then those of every slot in turn.
pub fn visit<T: Scalar>(arms: &mut Arms<T>, v: &mut impl FieldVisitor<T>) {
    visit_launcher(arms, v);
    arms.slots.iter_mut().for_each(|slot| visit_projectile(slot, v));
}

/// Walks the fields of the launcher itself.
pub fn visit_launcher<T: Scalar>(arms: &mut Arms<T>, v: &mut impl FieldVisitor<T>) {
    v.int("cooldown", &mut arms.cooldown);
    v.int("ammo", &mut arms.ammo);
}

fn visit_projectile<T: Scalar>(p: &mut Projectile<T>, v: &mut impl FieldVisitor<T>) {
    v.int("phase", &mut p.phase);
    v.int("age", &mut p.age);
    v.int("clock", &mut p.clock);
    visit_vector(v, "local_position", &mut p.position);
    v.int("tile_x", &mut p.tile_x);
    v.int("tile_y", &mut p.tile_y);
    visit_vector(v, "velocity", &mut p.velocity);
    visit_vector(v, "axis", &mut p.axis);
}
