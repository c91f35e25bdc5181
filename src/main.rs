use candor::tracer::Tracer;
fn main() {
    let scene = candor::scene::load("scenes/two-spheres.toml".as_ref()).unwrap();
    let adapters = candor::gpu::adapters();
    let mut t = candor::gpu::GpuTracer::new(&scene, &adapters[0]).unwrap();
    for r in 0..6 {
        let t0 = std::time::Instant::now();
        t.add_samples(r * 32..(r + 1) * 32).unwrap();
        println!("{:.2} Ms/s", 262144. * 32. / t0.elapsed().as_secs_f64() / 1e6);
    }
    let f = t.film().unwrap();
    let m: f64 = f.pixels().iter().map(|p| candor::film::sums(p)[1] as f64).sum::<f64>() * f.scale().step() / 262144. / f.samples().count() as f64;
    println!("mean {m} {:?} {}", t.ledger().unwrap(), f.scale().shift());
}
