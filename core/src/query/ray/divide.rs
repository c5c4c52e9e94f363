//! Divides a list of boxes in two by the surface area heuristic.
//!
//! # Source
//! Bins of centres: Wald 2007, "On fast construction of SAH-based bounding volume hierarchies".

use super::block::LANES;
use super::cell::Span;

/// The number of bins on each axis, whose borders are the candidate cuts.
const BINS: usize = 16;

/// To choose a cut of a longer list, about this many of its facets are sampled.
const FACETS_SAMPLED: usize = 4096;

/// A list of at most this many facets makes two blocks: it is divided in the middle.
const MAX_FACETS_OF_TWO_BLOCKS: usize = 2 * LANES;

/// After this many cuts in succession lists are halved, which soon ends; no real scene needs as many.
const MAX_LEVELS_OF_CUTS: u32 = 64;

/// A facet and its box.
#[derive(Clone, Copy, Debug)]
pub struct BoxedFacet {
    /// The facet's index in the scene.
    pub facet: u32,
    /// The box of the facet.
    pub span: Span,
}

impl BoxedFacet {
    /// Makes an entry of a facet and its box.
    pub fn new(facet: u32, span: Span) -> Self {
        Self { facet, span }
    }

    /// Twice the centre of the box on an axis.
    #[inline]
    fn centre(&self, axis: usize) -> f32 {
        self.span.low[axis] + self.span.high[axis]
    }
}

/// Divides a list into two nonempty parts; returns the length of the first part and the boxes of both.
pub fn divide<const D: usize>(
    items: &mut [BoxedFacet],
    whole: &Span,
    level: u32,
) -> (usize, [Span; 2]) {
    let cut = match items.len() {
        ..=MAX_FACETS_OF_TWO_BLOCKS => None,
        _ if level >= MAX_LEVELS_OF_CUTS => None,
        _ => best::<D>(items),
    };
    let Some(cut) = cut else {
        return halve::<D>(items, whole);
    };
    let count = partition(items, |item| cut.below(item));
    if items.len() < 2 * FACETS_SAMPLED {
        return (count, cut.spans);
    }
    let (below, above) = items.split_at(count);
    (count, [around(below), around(above)])
}

/// Cuts chosen for a long list, as a small tree whose leaves are parts of the list.
pub struct Cuts<const D: usize> {
    cuts: Vec<(Cut, [Way; 2])>,
}

/// The content on one side of a cut: another cut, or a part of the list.
#[derive(Clone, Copy)]
enum Way {
    Cut(usize),
    Part(usize),
}

impl<const D: usize> Cuts<D> {
    /// Chooses, by a sample, cuts that divide a long list into up to `parts` parts; `None` if there is none.
    pub fn of(items: &[BoxedFacet], parts: usize) -> Option<Self> {
        let mut sample: Vec<BoxedFacet> = sample(items).copied().collect();
        let mut open = vec![(0..sample.len(), around(&sample).surface::<D>(), None)];
        let mut cuts: Vec<(Cut, [Way; 2])> = Vec::new();
        while open.len() < parts {
            let largest = open
                .iter()
                .enumerate()
                .filter(|(_, part)| part.0.len() > MAX_FACETS_OF_TWO_BLOCKS);
            let largest = largest.max_by(|a, b| a.1 .1.total_cmp(&b.1 .1));
            let Some(place) = largest.map(|(place, _)| place) else {
                break;
            };
            let (range, _, above) = open[place].clone();
            let cut = best::<D>(&sample[range.clone()])?;
            let count = partition(&mut sample[range.clone()], |item| cut.below(item));
            let middle = range.start + count;
            let number = cuts.len();
            let surfaces = cut.spans.map(|span| span.surface::<D>());
            cuts.push((cut, [Way::Part(place), Way::Part(open.len())]));
            if let Some((from, side)) = above {
                let (_, ways): &mut (Cut, [Way; 2]) = &mut cuts[from];
                ways[side] = Way::Cut(number);
            }
            open[place] = (range.start..middle, surfaces[0], Some((number, 0)));
            open.push((middle..range.end, surfaces[1], Some((number, 1))));
        }
        (!cuts.is_empty()).then_some(Self { cuts })
    }

    /// Returns the facets of each part of the list, with the box around them.
    pub fn divided(&self, items: &[BoxedFacet]) -> Vec<(Vec<BoxedFacet>, Span)> {
        let mut parts = vec![(Vec::new(), Span::NOTHING); self.cuts.len() + 1];
        for item in items {
            let (part, span) = &mut parts[self.part(item)];
            part.push(*item);
            *span = span.with(&item.span);
        }
        parts
    }

    #[inline]
    fn part(&self, item: &BoxedFacet) -> usize {
        let mut at = 0;
        loop {
            let (cut, ways) = &self.cuts[at];
            match ways[usize::from(!cut.below(item))] {
                Way::Cut(next) => at = next,
                Way::Part(part) => return part,
            }
        }
    }
}

fn around(items: &[BoxedFacet]) -> Span {
    Span::around(items.iter().map(|item| &item.span))
}

/// Moves the facets for which `below` is true to the start of the list; returns their number.
fn partition(items: &mut [BoxedFacet], below: impl Fn(&BoxedFacet) -> bool) -> usize {
    let mut count = 0;
    for at in 0..items.len() {
        if below(&items[at]) {
            items.swap(at, count);
            count += 1;
        }
    }
    count
}

/// Halves a list by the centres of its boxes on the longest axis of the box `whole`.
fn halve<const D: usize>(items: &mut [BoxedFacet], whole: &Span) -> (usize, [Span; 2]) {
    let middle = items.len().div_ceil(2);
    let order = |axis: usize| {
        move |a: &BoxedFacet, b: &BoxedFacet| {
            let centres = a.centre(axis).total_cmp(&b.centre(axis));
            centres.then_with(|| a.facet.cmp(&b.facet))
        }
    };
    let size = |axis: usize| whole.high[axis] - whole.low[axis];
    let widest = (0..D).max_by(|a, b| size(*a).total_cmp(&size(*b)));
    items.select_nth_unstable_by(middle, order(widest.unwrap_or(0)));
    let (first, rest) = items.split_at(middle);
    (middle, [around(first), around(rest)])
}

/// A cut between two bins of an axis, with its cost.
struct Cut {
    axis: usize,
    bins: Bins,
    /// The first bin above the cut.
    at: usize,
    spans: [Span; 2],
    cost: f32,
}

impl Cut {
    fn below(&self, item: &BoxedFacet) -> bool {
        self.bins.of(item.centre(self.axis)) < self.at
    }
}

/// Divides the range of centres on an axis into equal bins.
#[derive(Clone, Copy)]
struct Bins {
    low: f32,
    factor: f32,
}

impl Bins {
    #[inline]
    fn of(self, centre: f32) -> usize {
        // Centres outside the range of the sample go to the first or the last bin.
        (((centre - self.low) * self.factor) as usize).min(BINS - 1)
    }
}

#[derive(Clone, Copy)]
struct Bin {
    span: Span,
    count: u32,
}

impl Bin {
    const EMPTY: Self = Self {
        span: Span::NOTHING,
        count: 0,
    };

    #[inline]
    fn take(&mut self, span: &Span, count: u32) {
        self.span = self.span.with(span);
        self.count += count;
    }

    /// Returns the cost of testing the blocks of facets in the bin, weighted by the probability that a ray
    /// meets the bin's box.
    fn cost<const D: usize>(&self) -> f32 {
        self.span.surface::<D>() * self.count.div_ceil(LANES as u32) as f32
    }
}

fn sample(items: &[BoxedFacet]) -> impl Iterator<Item = &BoxedFacet> {
    items.iter().step_by((items.len() / FACETS_SAMPLED).max(1))
}

/// Returns the cut of least cost for a sample of a list; `None` if the centres of all boxes are equal.
fn best<const D: usize>(items: &[BoxedFacet]) -> Option<Cut> {
    let sample = || sample(items);
    let (mut low, mut high) = ([f32::INFINITY; D], [f32::NEG_INFINITY; D]);
    for item in sample() {
        for k in 0..D {
            let centre = item.centre(k);
            low[k] = if centre < low[k] { centre } else { low[k] };
            high[k] = if centre > high[k] { centre } else { high[k] };
        }
    }
    let bins: [Bins; D] = std::array::from_fn(|k| Bins {
        low: low[k],
        factor: BINS as f32 / (high[k] - low[k]).max(f32::MIN_POSITIVE),
    });
    let mut full = [[Bin::EMPTY; BINS]; D];
    for item in sample() {
        for k in 0..D {
            full[k][bins[k].of(item.centre(k))].take(&item.span, 1);
        }
    }
    let axes = (0..D).filter(|k| high[*k] > low[*k]);
    let cuts = axes.filter_map(|axis| cheapest::<D>(axis, bins[axis], &full[axis]));
    cuts.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

fn cheapest<const D: usize>(axis: usize, bins: Bins, full: &[Bin; BINS]) -> Option<Cut> {
    let mut rest = [Bin::EMPTY; BINS];
    let mut above = Bin::EMPTY;
    for at in (1..BINS).rev() {
        above.take(&full[at].span, full[at].count);
        rest[at] = above;
    }
    let mut below = Bin::EMPTY;
    let mut found: Option<Cut> = None;
    for at in 1..BINS {
        below.take(&full[at - 1].span, full[at - 1].count);
        if below.count == 0 || rest[at].count == 0 {
            continue;
        }
        let cost = below.cost::<D>() + rest[at].cost::<D>();
        if found.as_ref().is_none_or(|cut| cost < cut.cost) {
            let spans = [below.span, rest[at].span];
            found = Some(Cut {
                axis,
                bins,
                at,
                spans,
                cost,
            });
        }
    }
    found
}
