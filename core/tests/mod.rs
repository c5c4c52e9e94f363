//! Tests of the crate as others see it: modules of one build, which compiles the crate once.

mod arith;
mod arith_bounds;
mod booleans;
mod boxes;
mod crowds;
mod deep;
mod expressions;
mod fuzz_targets;
mod half_spaces;
mod laws_chains;
mod laws_dim1;
mod laws_dim2;
mod laws_dim3;
mod laws_motions;
mod laws_solids;
mod layering;
mod leaf_against_merge;
mod panics;
mod rays;
mod regions;
mod revisions;
mod sizes;
mod support;
mod sweeps;
mod traces;
mod voxels;
mod watching;

#[expect(dead_code, reason = "libFuzzer's targets write seeds as files")]
#[path = "../../fuzz/src/lib.rs"]
mod fuzz;
