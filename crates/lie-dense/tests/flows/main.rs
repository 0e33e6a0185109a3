//! Flows of matrices, compiled together: as programs of their own each of the three had the methods compiled once more.

mod rigid_body;
mod sphere;
mod systems;
