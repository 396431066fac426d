//! Speed of the kernels, batch at each vector width against one element at a time, from coordinates in the first-level
//! cache. `cargo bench` fails where the machine has AVX2 and a batch is not at least twice as fast: then a kernel no longer
//! becomes vector code. Who only lists or tries the benchmarks (in a debug build, say) is told no ratio.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput};
use meshgauge::measures::batch::{geometry_at, quadrilaterals_at, tetrahedra_at, triangles_at};
use meshgauge::measures::{Corner, Geometry, LANES, Lanes, geometry, quadrilateral, tetrahedron, triangle};
use meshgauge::mesh::Shape;
use meshgauge::width::Width;

/// Elements measured in one go: enough that a branch predictor does not learn them by heart.
const BATCHES: usize = 32;

/// One corner of a regular element, moved a little at random.
type Elements<const N: usize> = Vec<[[f64; 3]; N]>;

fn elements<const N: usize>(regular: [[f64; 3]; N]) -> Elements<N> {
    let mut state = 1u64;
    let mut jitter = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.4 * ((state >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
    };
    (0..BATCHES * LANES).map(|_| regular.map(|point| point.map(|c| c + jitter()))).collect()
}

fn side_by_side<const N: usize>(elements: &Elements<N>) -> Vec<[Corner; N]> {
    let mut batches = vec![[[[0.0; LANES]; 3]; N]; elements.len() / LANES];
    for (i, element) in elements.iter().enumerate() {
        for (corner, point) in batches[i / LANES].iter_mut().zip(element) {
            for (axis, c) in corner.iter_mut().zip(point) {
                axis[i % LANES] = *c;
            }
        }
    }
    batches
}

/// Measures one kernel at every width and one element at a time.
fn bench(
    criterion: &mut Criterion,
    name: &str,
    mut one_by_one: impl FnMut(),
    mut side_by_side: impl FnMut(Width),
) {
    let mut group = criterion.benchmark_group(name);
    group.throughput(Throughput::Elements((BATCHES * LANES) as u64));
    group.bench_function("one by one", |bencher| bencher.iter(&mut one_by_one));
    for width in Width::available() {
        let id = BenchmarkId::new("batch", width.name());
        group.bench_with_input(id, &width, |bencher, &width| bencher.iter(|| side_by_side(width)));
    }
    group.finish();
    if !is_measured() {
        return;
    }

    let alone = nanoseconds(&mut one_by_one);
    print!("{name}, ns an element: {alone:.1} one by one");
    let mut last = None;
    for width in Width::available() {
        let batch = nanoseconds(&mut || side_by_side(width));
        print!(", {batch:.1} with {}", width.name());
        if width != Width::BASELINE {
            last = Some(batch);
        }
    }
    println!();
    if let Some(batch) = last {
        assert!(batch * 2.0 <= alone, "{name}: a batch is only {:.2} times as fast", alone / batch);
    }
}

/// Whether `cargo bench` runs this: it says so, and others do not.
fn is_measured() -> bool {
    let given = |flag: &str| std::env::args().any(|argument| argument == flag);
    given("--bench") && !given("--list") && !given("--test")
}

/// The best of several short runs, in nanoseconds an element: neighbours on a shared machine only ever slow one down.
fn nanoseconds(run: &mut impl FnMut()) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..60 {
        let start = Instant::now();
        for _ in 0..4 {
            run();
        }
        best = best.min(start.elapsed().as_nanos() as f64);
    }
    best / (4 * BATCHES * LANES) as f64
}

fn bench_scores<const N: usize, const M: usize>(
    criterion: &mut Criterion,
    name: &str,
    regular: [[f64; 3]; N],
    one: fn(&[[f64; 3]; N]) -> [f64; M],
    many: fn(Width, [&Corner; N], &mut [Lanes; M]),
) {
    let elements = elements(regular);
    let batches = side_by_side(&elements);
    let mut out = [[0.0; LANES]; M];
    bench(
        criterion,
        name,
        || {
            for element in &elements {
                black_box(one(black_box(element)));
            }
        },
        |width| {
            for corners in &batches {
                many(width, corners.each_ref(), &mut out);
                black_box(&out);
            }
        },
    );
}

fn bench_geometry<const N: usize>(criterion: &mut Criterion, shape: Shape, regular: [[f64; 3]; N]) {
    let elements = elements(regular);
    let batches = side_by_side(&elements);
    let mut out = Geometry::default();
    bench(
        criterion,
        &format!("geometry of {shape}"),
        || {
            for element in &elements {
                black_box(geometry::of(shape, black_box(element)));
            }
        },
        |width| {
            for corners in &batches {
                geometry_at(width, shape, corners, &mut out);
                black_box(&out);
            }
        },
    );
}

fn main() {
    let mut criterion = Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .sample_size(20)
        .configure_from_args();
    let regular = [[1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, 1.0]];
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let top = square.map(|[x, y, _]| [x, y, 1.0]);
    let cube = [square[0], square[1], square[2], square[3], top[0], top[1], top[2], top[3]];
    let equilateral = [square[0], square[1], [0.5, 0.866, 0.0]];

    bench_scores(&mut criterion, "tetrahedra", regular, tetrahedron::score, tetrahedra_at);
    bench_scores(&mut criterion, "triangles", equilateral, triangle::score, triangles_at);
    bench_scores(&mut criterion, "quadrilaterals", square, quadrilateral::score, quadrilaterals_at);
    bench_geometry(&mut criterion, Shape::Tetrahedron, regular);
    bench_geometry(&mut criterion, Shape::Hexahedron, cube);
    criterion.final_summary();
}
