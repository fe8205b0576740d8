// What was told over time, in columns: fine what is recent, coarse and evenly so what is older.
const FINE = 6000, COARSE = 6000; // rows: five minutes of 20 frames a second, and all before these
const PORTION = 512; // fine rows that become coarse at once

// What rows become that share one: ends of a range, or what differs more from the row before.
const KINDS = {
  least: (a, b) => (a === null ? b : b === null ? a : Math.min(a, b)),
  most: (a, b) => (a === null ? b : b === null ? a : Math.max(a, b)),
  swing: (a, b, before) => (a === null ? b : b === null || Math.abs(b - before) < Math.abs(a - before) ? a : b),
};

export class Record {
  constructor(kinds) { this.kinds = kinds; this.clear(); }

  clear() {
    this.t = [];
    this.columns = this.kinds.map(() => []);
    this.old = 0; // coarse rows, each of `step` fine ones
    this.step = 2;
  }

  get first() { return this.t[0] ?? 0; }

  get last() { return this.t.at(-1) ?? 0; }

  add(t, row) {
    this.t.push(t);
    this.columns.forEach((column, k) => column.push(row[k]));
    const portion = Math.max(PORTION, this.step);
    if (this.t.length - this.old < FINE + portion) return;
    this.fold(this.old, portion, this.step);
    this.old += portion / this.step;
    if (this.old < COARSE) return;
    const even = this.old - (this.old % 2);
    this.fold(0, even, 2);
    this.old -= even / 2;
    this.step *= 2;
  }

  // Let so many rows share one each.
  fold(from, count, by) {
    const starts = this.starts(from, from + count, by);
    const folded = this.columns.map((_, k) => this.shared(k, starts, by));
    this.columns.forEach((column, k) => column.splice(from, count, ...folded[k]));
    this.t.splice(from, count, ...starts.map((start) => this.t[start]));
  }

  starts(from, to, by) { return Array.from({ length: Math.ceil((to - from) / by) }, (_, i) => from + i * by); }

  // A column of rows that begin there and share so many each.
  shared(k, starts, by) {
    const column = this.columns[k], join = KINDS[this.kinds[k]], found = [];
    for (const start of starts) {
      const before = found.at(-1) ?? column[start - 1] ?? column[start + by] ?? 0; // at first, that after
      const end = Math.min(start + by, column.length);
      let value = column[start];
      for (let i = start + 1; i < end; i++) value = join(value, column[i], before);
      found.push(value);
    }
    return found;
  }

  // Times and columns for a picture of some time: no more rows than it can show.
  picture(range, columns, most) {
    const [a, b] = this.around(range), by = 2 ** Math.max(0, Math.ceil(Math.log2((b - a) / most)));
    const starts = this.starts(a - (a % by), b, by); // so that what scrolls does not tremble
    return [starts.map((start) => this.t[start]), ...columns.map((k) => this.shared(k, starts, by))];
  }

  // The first row at or after a time.
  at(time) {
    let [low, high] = [0, this.t.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.t[middle] < time) low = middle + 1; else high = middle;
    }
    return low;
  }

  // From which to which row a time goes, with one more at each end: lines go on beyond a picture.
  around([from, to]) { return [Math.max(0, this.at(from) - 1), Math.min(this.t.length, this.at(to) + 2)]; }
}
