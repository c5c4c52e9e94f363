//! Copies of solids whose sources have new ids, so that attributes of the original do not apply to the copy.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;

use super::node::{Branch, DeferredLeaf, FaceGroup, Node, Part, PartElement};
use super::solid::Solid;
use crate::interrupt::poll;
use crate::mesh::cached::Cached;
use crate::mesh::source::Source;

impl Solid {
    /// The same solid over copies of its sources with new ids.
    #[must_use]
    pub fn renamed(&self) -> Self {
        let mut renaming = Renaming::default();
        let sources: Vec<_> = self.sources().iter().map(|s| renaming.source(s)).collect();
        self.of_others(renaming.branch(self.root()), sources.iter().collect())
    }
}

/// The copies of sources, nodes and parts, each made once. Keys of nodes and parts are addresses, valid while
/// the solid exists.
#[derive(Default)]
struct Renaming {
    sources: HashMap<u64, Arc<Source>>,
    nodes: HashMap<*const Node, Arc<Node>>,
    parts: HashMap<*const Part, Arc<Part>>,
}

impl Renaming {
    fn source(&mut self, source: &Arc<Source>) -> Arc<Source> {
        let renamed = || Arc::new(source.renamed());
        Arc::clone(self.sources.entry(source.id()).or_insert_with(renamed))
    }

    fn branch(&mut self, root: &Branch) -> Branch {
        let mut open = vec![root];
        while let Some(branch) = open.last().copied() {
            poll();
            let waiting = open.len();
            if let Node::Cut(halves) = &*branch.node {
                let unmade = |b: &&Branch| !self.nodes.contains_key(&Arc::as_ptr(&b.node));
                open.extend(halves.children.iter().filter(unmade));
            }
            if open.len() == waiting {
                let node = self.node(&branch.node);
                self.nodes.insert(Arc::as_ptr(&branch.node), node);
                open.pop();
            }
        }
        self.replaced(root)
    }

    /// The copy of a node whose children are copied already.
    fn node(&mut self, node: &Arc<Node>) -> Arc<Node> {
        match &**node {
            Node::Leaf(_) => Arc::clone(node),
            Node::Deferred(leaf) => Arc::new(Node::Deferred(self.leaf(leaf))),
            Node::Cut(halves) => {
                let [minus, plus] = halves.children.each_ref().map(|b| self.replaced(b));
                Arc::new(Node::cut(minus, plus))
            }
        }
    }

    fn replaced(&self, branch: &Branch) -> Branch {
        Branch {
            node: Arc::clone(&self.nodes[&Arc::as_ptr(&branch.node)]),
            ..branch.clone()
        }
    }

    fn leaf(&mut self, leaf: &DeferredLeaf) -> DeferredLeaf {
        let group = |g: &FaceGroup| FaceGroup {
            source: self.source(&g.source),
            ..g.clone()
        };
        let groups = leaf.groups.iter().map(group).collect();
        let part = |p: &PartElement| PartElement {
            part: self.part(&p.part),
            ..p.clone()
        };
        DeferredLeaf {
            groups,
            parts: leaf.parts.iter().map(part).collect(),
            corner: leaf.corner,
            by_kernel: leaf.by_kernel,
            share: Cached::new(),
        }
    }

    fn part(&mut self, part: &Arc<Part>) -> Arc<Part> {
        let source = self.source(&part.source);
        let renamed = || {
            Arc::new(Part {
                source,
                face: part.face,
                home: part.home,
                edges: part.edges.clone(),
                around: part.around,
                flux: Cached::new(),
            })
        };
        let known = self.parts.entry(Arc::as_ptr(part));
        Arc::clone(known.or_insert_with(renamed))
    }
}
