//! Benchmarks of the kernels: `cargo bench -p shearbed-benches`.
