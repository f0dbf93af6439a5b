//! Names beside markers, where there is room for them.

/// A rectangle in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    /// So far to every side.
    pub(super) fn around([x, y]: [f64; 2], r: f64) -> Self {
        Self { left: x - r, top: y - r, width: 2.0 * r, height: 2.0 * r }
    }

    fn shared(&self, other: &Self) -> f64 {
        let along = |a: f64, width: f64, b: f64, other: f64| ((a + width).min(b + other) - a.max(b)).max(0.0);
        along(self.left, self.width, other.left, other.width) * along(self.top, self.height, other.top, other.height)
    }

    fn is_within(&self, other: &Self) -> bool {
        self.left >= other.left
            && self.top >= other.top
            && self.left + self.width <= other.left + other.width
            && self.top + self.height <= other.top + other.height
    }
}

/// What is in the way of names, and how much each pixel of it is worth.
#[derive(Debug)]
pub(super) struct Room {
    bounds: Area,
    taken: Vec<(Area, f64)>,
}

/// A name, put.
#[derive(Clone, Copy, Debug)]
pub(super) struct Put {
    pub(super) area: Area,
    /// Where a line from the marker ends, if the name is not right beside it.
    pub(super) leader: Option<[f64; 2]>,
}

/// What must not be covered.
pub(super) const MUST: f64 = 1000.0;

impl Room {
    pub(super) const fn new(bounds: Area) -> Self {
        Self { bounds, taken: vec![] }
    }

    pub(super) fn take(&mut self, area: Area, worth: f64) {
        self.taken.push((area, worth));
    }

    /// Takes a line in steps of a few pixels.
    pub(super) fn take_line(&mut self, from: [f64; 2], to: [f64; 2], worth: f64) {
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let steps = (length / 4.0).ceil().max(1.0);
        let mut step = 0.0;
        while step <= steps {
            let along = |axis: usize| from[axis] + (to[axis] - from[axis]) * step / steps;
            self.take(Area::around([along(0), along(1)], 2.0), worth);
            step += 1.0;
        }
    }

    /// Puts a name of that size near a marker of `r` pixels, where it covers least.
    pub(super) fn put(&mut self, [x, y]: [f64; 2], r: f64, [width, height]: [f64; 2]) -> Put {
        const TURNS: [f64; 16] = [0.0, 8.0, 4.0, 12.0, 1.0, 15.0, 7.0, 9.0, 2.0, 14.0, 6.0, 10.0, 3.0, 13.0, 5.0, 11.0];
        let mut best: Option<(f64, Put)> = None;
        for ring in [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0] {
            for (place, turn) in (0_u8..).zip(TURNS) {
                let away = r + 3.0 + 9.0 * ring;
                let (sin, cos) = (turn * std::f64::consts::PI / 8.0).sin_cos();
                let middle = [x + cos * (away + width / 2.0), y + sin * (away + height / 2.0)];
                let area = Area { left: middle[0] - width / 2.0, top: middle[1] - height / 2.0, width, height };
                if !area.is_within(&self.bounds) {
                    continue;
                }
                let covered: f64 = self.taken.iter().map(|(taken, worth)| worth * area.shared(taken)).sum();
                let cost = covered + 12.0 * ring + 0.4 * f64::from(place);
                if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                    let end = |at: f64, from: f64, size: f64| at.clamp(from, from + size);
                    let end = [end(x, area.left, width), end(y, area.top, height)];
                    best = Some((cost, Put { area, leader: (ring > 0.5).then_some(end) }));
                }
            }
        }
        let beside = Area { left: x + r + 3.0, top: y - height / 2.0, width, height };
        let put = best.map_or(Put { area: beside, leader: None }, |(_, put)| put);
        self.take(put.area, MUST);
        if let Some(end) = put.leader {
            self.take_line([x, y], end, 3.0);
        }
        put
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_markers_in_a_heap_do_not_overlap() {
        let mut room = Room::new(Area { left: 0.0, top: 0.0, width: 400.0, height: 300.0 });
        let markers: Vec<[f64; 2]> = (0..9).map(|k| [200.0 + f64::from(k % 3), 150.0 + f64::from(k / 3)]).collect();
        markers.iter().for_each(|marker| room.take(Area::around(*marker, 8.0), MUST));
        let put: Vec<Area> = markers.iter().map(|marker| room.put(*marker, 8.0, [80.0, 14.0]).area).collect();
        for (place, area) in put.iter().enumerate() {
            assert!(area.is_within(&room.bounds), "{area:?}");
            assert!(put[..place].iter().all(|other| area.shared(other) <= 0.0), "{area:?} of {put:?}");
            assert!(markers.iter().all(|marker| area.shared(&Area::around(*marker, 8.0)) <= 0.0), "{area:?}");
        }
    }

    #[test]
    fn a_name_with_room_is_right_beside_its_marker() {
        let mut room = Room::new(Area { left: 0.0, top: 0.0, width: 400.0, height: 300.0 });
        let put = room.put([100.0, 100.0], 8.0, [80.0, 14.0]);
        assert!(put.leader.is_none() && (put.area.left - 111.0).abs() < 1e-9, "{put:?}");
        let put = room.put([390.0, 100.0], 8.0, [80.0, 14.0]);
        assert!(put.leader.is_none() && put.area.left < 310.0, "at the right end it is on the left: {put:?}");
    }
}
