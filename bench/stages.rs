//! Speed of the stages around the kernels: nodes found and corners gathered, scores taken into statistics, numbers read
//! from text, statistics merged. One thread, from memory.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use meshgauge::Result;
use meshgauge::formats::{BLOCK, Chunks, ElementSink, text};
use meshgauge::input::{Budget, Scratch};
use meshgauge::measures::{Corner, LANES, Lanes};
use meshgauge::mesh::{Chunk, ElementType, Nodes, NodesBuilder, Shape, gather, prefetch};
use meshgauge::statistics::{Distribution, Moments, Tree};
use meshgauge::width::{Wide, at_widest};

/// Nodes along each side of a cube of Kuhn's tetrahedra.
const SIDE: u32 = 60;

/// Numbers without order, the same at every run.
fn noise() -> impl FnMut() -> u64 {
    let mut state = 1u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state >> 11
    }
}

fn points() -> Vec<[f64; 3]> {
    let place = |k: u32| [k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE].map(f64::from);
    (0..SIDE * SIDE * SIDE).map(place).collect()
}

/// Corners of tetrahedra, six in each cell of the cube.
fn tetrahedra() -> Vec<[u32; 4]> {
    let steps = [1, SIDE, SIDE * SIDE];
    let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let cells = 0..(SIDE - 1).pow(3);
    let first = |k: u32| {
        let side = SIDE - 1;
        k % side + (k / side % side) * SIDE + (k / side / side) * SIDE * SIDE
    };
    let corners = |a: u32, [i, j, k]: [usize; 3]| {
        let (b, c) = (a + steps[i], a + steps[i] + steps[j]);
        [a, b, c, c + steps[k]]
    };
    cells.flat_map(|cell| orders.map(|order| corners(first(cell), order))).collect()
}

fn nodes() -> Result<Nodes> {
    let (budget, scratch) = (Budget::default(), Scratch::new(&std::env::temp_dir(), 1 << 30));
    let mut builder = NodesBuilder::new(&budget, &scratch);
    let ids: Vec<u64> = (1..=u64::from(SIDE).pow(3)).collect();
    builder.extend(&ids, &points())?;
    builder.finish()
}

fn bench_gather(criterion: &mut Criterion) {
    let (points, ordered) = (points(), tetrahedra());
    let mut random = noise();
    let names: Vec<u32> = (0..points.len()).map(|_| (random() % points.len() as u64) as u32).collect();
    let shuffled: Vec<[u32; 4]> = ordered.iter().map(|t| t.map(|row| names[row as usize])).collect();
    let mut group = criterion.benchmark_group("gather");
    group.throughput(Throughput::Elements(ordered.len() as u64));
    for (name, elements) in [("nodes in order", &ordered), ("nodes in no order", &shuffled)] {
        let mut out: [Corner; 4] = [[[0.0; LANES]; 3]; 4];
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let mut blocks = elements.chunks(LANES).peekable();
                while let Some(block) = blocks.next() {
                    prefetch(&points, blocks.peek().map_or(&[], |next| next.as_flattened()));
                    gather::<4, LANES>(block.as_flattened(), &points, &mut out);
                    black_box(&out);
                }
            });
        });
    }
    group.finish();
}

/// One chunk that goes round.
#[derive(Default)]
struct Round(Option<Chunk>);

impl Chunks for Round {
    fn empty(&mut self) -> Result<Chunk> {
        Ok(self.0.take().unwrap_or_default())
    }

    fn hand_on(&mut self, chunk: Chunk) -> Result<()> {
        self.0 = Some(chunk);
        Ok(())
    }
}

fn bench_sink(criterion: &mut Criterion) -> Result<()> {
    let nodes = nodes()?;
    let ids: Vec<[u64; 4]> = tetrahedra().iter().map(|t| t.map(|row| u64::from(row) + 1)).collect();
    let labels: Vec<u64> = (1..=ids.len() as u64).collect();
    let kind = Arc::new(ElementType::measured("tetrahedron", Shape::Tetrahedron, 1, 4));
    let mut chunks = Round::default();
    let mut group = criterion.benchmark_group("sink");
    group.throughput(Throughput::Elements(ids.len() as u64));
    group.bench_function("blocks of tetrahedra", |bencher| {
        bencher.iter(|| {
            let mut sink = ElementSink::new(&nodes, &mut chunks, 0, false);
            for (labels, ids) in labels.chunks(BLOCK).zip(ids.chunks(BLOCK)) {
                let taken = sink.block(&kind, labels, ids.as_flattened());
                assert!(taken.is_ok_and(|taken| taken), "every node is known");
            }
            black_box(sink.finish().is_ok())
        });
    });
    group.finish();
    Ok(())
}

/// What the pipeline does with the scores of a block.
struct Record<'a> {
    scores: &'a [Lanes; 4],
    moments: &'a mut Moments,
    bins: &'a mut [Distribution; 4],
}

impl Wide for Record<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (bins, scores) in self.bins.iter_mut().zip(self.scores) {
            bins.record(scores);
        }
        let columns = self.scores.each_ref().map(|column| &column[..]);
        self.moments.extend(&columns, 0);
    }
}

fn bench_statistics(criterion: &mut Criterion) {
    let mut random = noise();
    let mut score = || 1.0 - 0.5 * (random() as f64 / (1u64 << 53) as f64).powi(2);
    let blocks: Vec<[Lanes; 4]> =
        (0..64).map(|_| std::array::from_fn(|_| std::array::from_fn(|_| score()))).collect();
    let mut group = criterion.benchmark_group("statistics");
    group.throughput(Throughput::Elements((blocks.len() * LANES) as u64));
    let (mut moments, mut bins) = (Moments::default(), [(); 4].map(|()| Distribution::default()));
    group.bench_function("four scores an element", |bencher| {
        bencher.iter(|| {
            for scores in &blocks {
                at_widest(Record { scores, moments: &mut moments, bins: &mut bins });
            }
        });
    });
    group.throughput(Throughput::Elements(1024));
    group.bench_function("merge of 1024 chunks", |bencher| {
        bencher.iter(|| {
            let mut tree = Tree::new(Moments::merge);
            (0..1024).for_each(|_| tree.push(black_box(&moments).clone()));
            black_box(tree.finish())
        });
    });
    group.finish();
}

fn bench_text(criterion: &mut Criterion) {
    let mut random = noise();
    let integers: String =
        (0..20_000).map(|k| format!("{k}, {}, {}\n", random() % 300_000, random() % 300_000)).collect();
    let reals: String =
        (0..20_000).map(|_| format!("{:?}\n", random() as f64 / (1u64 << 53) as f64)).collect();
    let mut group = criterion.benchmark_group("text");
    group.throughput(Throughput::Bytes(integers.len() as u64));
    group.bench_with_input(
        BenchmarkId::from_parameter("whole numbers"),
        integers.as_bytes(),
        |bencher, bytes| {
            bencher.iter(|| {
                let (mut at, mut sum) = (0, 0u64);
                while at < bytes.len() {
                    sum = sum.wrapping_add(text::digits(bytes, &mut at).unwrap_or_default());
                    at += bytes[at..].iter().take_while(|b| !b.is_ascii_digit()).count();
                }
                sum
            });
        },
    );
    group.throughput(Throughput::Bytes(reals.len() as u64));
    group.bench_with_input(
        BenchmarkId::from_parameter("real numbers"),
        reals.as_bytes(),
        |bencher, bytes| {
            bencher.iter(|| {
                let rows = text::lines(0, bytes).filter_map(|line| text::real(line.bytes));
                rows.sum::<f64>()
            });
        },
    );
    group.finish();
}

fn main() -> Result<()> {
    let mut criterion = Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .sample_size(20)
        .configure_from_args();
    bench_gather(&mut criterion);
    bench_sink(&mut criterion)?;
    bench_statistics(&mut criterion);
    bench_text(&mut criterion);
    criterion.final_summary();
    Ok(())
}
