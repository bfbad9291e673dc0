"use strict";
// Draws the page from its data: numbers as JSON, arrays as one compressed block. It fetches nothing.

const byId = (id) => document.getElementById(id);
const sum = (values) => values.reduce((total, value) => total + value, 0);
const range = (count) => Array.from({ length: count }, (_, index) => index);
const dark = window.matchMedia("(prefers-color-scheme: dark)");
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
// Plotly has a button that sends a picture and its data to a server: there is none here.
const CONFIG = { responsive: true, displaylogo: false, showSendToCloud: false, plotlyServerURL: "",
  modeBarButtonsToRemove: ["select2d", "lasso2d", "zoomIn2d", "zoomOut2d", "autoScale2d", "orbitRotation", "tableRotation", "resetCameraLastSave3d"] };
const NOTHING = 65535; // scaled number of a place without material or without a value
const EMPTY = "no pressure here";

/** Text for a picture, in which Plotly finds no markup. */
const literal = (text) => String(text).replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");

/** Number with five significant digits, as a person writes it. */
function plain(value) {
  if (value === null || !Number.isFinite(value)) return "–";
  if (Math.abs(value) < 1e-9) return "0"; // rounding
  return Math.abs(value) >= 1e5 ? String(Math.round(value)) : String(Number(value.toPrecision(5)));
}

/** What finds an array of the page's block by its place. */
async function arraysOf(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const block = await new Response(stream).arrayBuffer();
  const kinds = { float32: Float32Array, float64: Float64Array, uint16: Uint16Array, uint32: Uint32Array };
  return ({ at, kind, shape }) => new kinds[kind](block, at, shape.reduce((size, length) => size * length, 1));
}

/** Layout of a picture in the page's colours. */
function layoutOf(more = {}, x = {}, y = {}) {
  const axis = { gridcolor: colour("grid"), zerolinecolor: colour("line"), linecolor: colour("line"), automargin: true };
  return {
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: colour("plot"), font: { color: colour("text"), size: 12 },
    margin: { l: 52, r: 12, t: 30, b: 40 }, hoverlabel: { align: "left" }, showlegend: false,
    legend: { orientation: "h", y: -0.24, yanchor: "top", x: 0 },
    modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("faint"), activecolor: colour("text") },
    xaxis: { ...axis, ...x, title: { text: x.title, standoff: 6 } },
    yaxis: { ...axis, ...y, title: { text: y.title, standoff: 6 } }, ...more,
  };
}

const saying = (text) => ({
  annotations: [{ text, showarrow: false, xref: "paper", yref: "paper", x: 0.5, y: 0.5, font: { size: 14 } }],
});
const colourBar = (title) => ({ title: { text: title, side: "right" }, thickness: 12, outlinewidth: 0 });
const lyingBar = (title, x) => ({ ...colourBar(title), title: { text: title, side: "top" }, orientation: "h", x, y: 0, yanchor: "top", len: 0.44, nticks: 5 });
const lineColours = () => colour("lines").split(" ");

/** Fill a select with names; its values are their numbers, or those given. */
function fill(select, names, values = range(names.length)) {
  select.replaceChildren(...names.map((name, index) => new Option(name, values[index])));
}

// ---------------------------------------------------------------------------------------------- a result

/** Weights of the values at -1, 0 and 1 in the parabola through them, at a place. */
const parabola = (s) => [0.5 * s * (s - 1), 1 - s * s, 0.5 * s * (s + 1)];

class Maps {
  /** Pressure maps of the page, each looked up by torque, position and tooth pair. */
  constructor(data, array) {
    [this.cells, this.pressure, this.places] = ["cells", "pressure", "places"].map((name) => array(data.maps[name]));
    this.shape = data.maps.cells.shape;
    this.width = data.maps.places.shape[1];
    this.starts = [];
    let [cell, number] = [0, 0];
    for (const index of range(this.cells.length / 2)) {
      const size = this.cells[2 * index] * this.cells[2 * index + 1];
      this.starts.push([cell, number]);
      cell += size;
      number += size > 0;
    }
  }

  at(torque, position, pair) {
    const index = (torque * this.shape[1] + position) * this.shape[2] + pair;
    const [across, along] = this.cells.subarray(2 * index, 2 * index + 2);
    const [cell, number] = this.starts[index];
    const place = this.places.subarray(this.width * number, this.width * (number + 1));
    return across === 0 ? null : new Map_(across, along, this.pressure.subarray(cell, cell + across * along), place);
  }
}

class Map_ {
  constructor(across, along, steps, place) {
    Object.assign(this, { across, along, steps, place });
    [this.x0, this.y0, this.dx, this.dy, this.step] = place;
    this.x = range(across).map((i) => this.x0 + i * this.dx);
    this.y = range(along).map((j) => this.y0 + j * this.dy);
  }

  isVoid(i, j) {
    return this.steps[i * this.along + j] === NOTHING;
  }

  /** Pressure of a cell [MPa]; null where there is none. */
  value(i, j) {
    const steps = this.steps[i * this.along + j];
    return steps === 0 || steps === NOTHING ? null : steps * this.step;
  }

  /** Place in the picture of a gear's flank of a point of the map, in cells from the middle of the first one. */
  onFlank(gear, i, j) {
    const across = parabola((2 * i + 1) / this.across - 1), along = parabola((2 * j + 1) / this.along - 1);
    const point = [0, 0];
    for (let a = 0; a < 3; a++) {
      for (let b = 0; b < 3; b++) {
        const node = 17 + 18 * gear + 2 * (3 * a + b), weight = across[a] * along[b];
        point[0] += weight * this.place[node];
        point[1] += weight * this.place[node + 1];
      }
    }
    return point;
  }

  /** Point in space, in cells from the middle of the first one and so far [mm] off the tangent plane. */
  inSpace(i, j, lift) {
    const p = this.place;
    const x = this.x0 + i * this.dx, y = this.y0 + j * this.dy;
    return [0, 1, 2].map((k) => p[5 + k] + x * p[8 + k] + y * p[11 + k] + lift * p[14 + k]);
  }

  /** Line load [N/mm] of each slice, and the middle of its pressure in cells; null without pressure. */
  slices() {
    return range(this.along).map((j) => {
      const values = range(this.across).map((i) => this.value(i, j) ?? 0), whole = sum(values);
      return whole > 0 ? { load: whole * this.dx, middle: sum(values.map((value, i) => value * i)) / whole } : null;
    });
  }
}

function drawResult(data, array) {
  const maps = new Maps(data, array);
  const inputs = { position: byId("position"), torque: byId("torque"), pair: byId("pair"), gear: byId("gear") };
  fill(inputs.pair, ["highest pressure", ...data.pairs.map((pair) => `pair ${pair}`)], ["", ...range(data.pairs.length)]);
  fill(inputs.gear, data.flanks.map((flank) => flank.name));
  const pairNames = data.pairs.map((pair) => `tooth pair ${pair}`);
  const state = () => {
    const [position, torque, gear] = ["position", "torque", "gear"].map((name) => Number(inputs[name].value));
    const pair = inputs.pair.value === "" ? data.peak_column[torque][position] : Number(inputs.pair.value);
    return { position, torque, gear, pair };
  };

  function drawState({ position, torque }) {
    byId("position-shown").textContent = data.positions[position];
    byId("torque-shown").textContent = data.torques[torque];
    inputs.position.setAttribute("aria-valuetext", data.positions[position]);
    inputs.torque.setAttribute("aria-valuetext", data.torques[torque]);
    const numbers = data.panels.slice(0, 4).map((panel) => {
      const values = panel.lines.map((line) => `${line.name} ${plain(line.values[torque][position])}`);
      return `${panel.title} [${panel.unit}]: ${values.join(", ")}`;
    });
    byId("state").textContent = numbers.join("; ");
  }

  function drawMap({ position, torque, pair }) {
    const map = maps.at(torque, position, pair);
    const titles = [{ title: "along the contact [mm]" }, { title: "across the contact [mm]" }];
    if (map === null) {
      Plotly.react("map", [], layoutOf(saying(`${pairNames[pair]}: ${EMPTY}`), ...titles), CONFIG);
      return;
    }
    const rows = range(map.across), columns = range(map.along);
    const grid = (of) => rows.map((i) => columns.map((j) => of(i, j)));
    const [first, right, above] = [map.onFlank(0, 0, 0), map.onFlank(0, 0, map.along - 1), map.onFlank(0, map.across - 1, 0)];
    titles[0].autorange = right[0] < first[0] ? "reversed" : true;
    titles[1].autorange = above[1] < first[1] ? "reversed" : true;
    const shared = { type: "heatmap", x: map.y, y: map.x };
    const traces = [
      { ...shared, z: grid((i, j) => (map.isVoid(i, j) ? 0 : null)), showscale: false, hoverinfo: "skip",
        colorscale: [[0, colour("void")], [1, colour("void")]] },
      { ...shared, z: grid((i, j) => map.value(i, j)), colorscale: "Viridis", zmin: 0, zmax: data.highest,
        colorbar: colourBar("contact pressure [MPa]"),
        hovertemplate: `${literal(pairNames[pair])}<br>along %{x:.4~g} mm, across %{y:.4~g} mm<br>%{z:.5~g} MPa<extra></extra>` },
      { x: [0], y: [0], mode: "markers", marker: { symbol: "cross-thin", size: 11, line: { color: colour("accent"), width: 2 } },
        hoverinfo: "skip" },
    ];
    const [pressure, minor, major] = data.hertz.map((values) => values[torque][position][pair]);
    const type = data.on_line[pair][position] ? "rect" : "circle";
    const hertz = { type, x0: -major, x1: major, y0: -minor, y1: minor, line: { color: colour("accent"), dash: "dash", width: 1.5 } };
    const shapes = pressure === null ? [] : [hertz];
    Plotly.react("map", traces, layoutOf({ shapes }, ...titles), CONFIG);
  }

  /** Outlines of a flank as shapes: not reached by the mating gear, and reached. */
  function flankLayout(flank, more) {
    const [whole, active] = flank.outlines.map((outline) => `M${outline.map((point) => point.join(",")).join("L")}Z`);
    const ground = { type: "path", layer: "below", line: { width: 0 } }, line = { type: "path", line: { color: colour("text"), width: 1 } };
    const shapes = [
      { ...ground, path: whole, fillcolor: colour("unreached") }, { ...ground, path: active, fillcolor: colour("plot") },
      { ...line, path: whole }, { ...line, path: active },
    ];
    const ends = range(2).map((axis) => ({ title: flank.axes[axis], range: [flank.low[axis], flank.high[axis]], showgrid: false, zeroline: false }));
    return layoutOf({ ...more, shapes, plot_bgcolor: colour("card") }, ...ends);
  }

  /** A picture of a flank whose fields have these pressures [MPa]; null where there is none. */
  function drawFields(id, flank, fields, template, more = {}) {
    const [rows, columns] = [fields.length, fields[0].length];
    const middles = (axis, count) => range(count).map((n) => flank.low[axis] + ((n + 0.5) / count) * (flank.high[axis] - flank.low[axis]));
    const trace = { type: "heatmap", x: middles(0, columns), y: middles(1, rows), z: fields, colorscale: "Viridis",
      zmin: 0, zmax: data.highest, colorbar: colourBar("contact pressure [MPa]"), hovertemplate: template, ...more };
    Plotly.react(id, [trace], flankLayout(flank, fields.some((row) => row.some((value) => value !== null)) ? {} : saying(EMPTY)), CONFIG);
  }

  function drawFlank({ position, torque, gear }) {
    const flank = data.flanks[gear], [, rows, columns] = flank.envelope.shape;
    const fields = range(rows).map(() => Array(columns).fill(null)), pairs = range(rows).map(() => Array(columns).fill(""));
    const field = (point) => [0, 1].map((axis) => (point[axis] - flank.low[axis]) / (flank.high[axis] - flank.low[axis]) * [columns, rows][axis]);
    for (const pair of range(pairNames.length)) {
      const map = maps.at(torque, position, pair);
      if (map === null) continue;
      const corner = field(map.onFlank(gear, 0, 0));
      const parts = [[1, 0], [0, 1]].map(([i, j]) => { // points in a cell, so close that no field stays empty
        const beside = field(map.onFlank(gear, i, j));
        return 1 + Math.floor(1.5 * Math.max(...[0, 1].map((axis) => Math.abs(beside[axis] - corner[axis]))));
      });
      for (let i = 0; i < map.across; i++) {
        for (let j = 0; j < map.along; j++) {
          const value = map.value(i, j);
          if (value === null) continue;
          for (let a = 0; a < parts[0]; a++) {
            for (let b = 0; b < parts[1]; b++) {
              const point = map.onFlank(gear, i + (a + 0.5) / parts[0] - 0.5, j + (b + 0.5) / parts[1] - 0.5);
              const [column, row] = field(point).map(Math.floor);
              if (row < 0 || row >= rows || column < 0 || column >= columns || fields[row][column] > value) continue;
              fields[row][column] = value;
              pairs[row][column] = literal(pairNames[pair]);
            }
          }
        }
      }
    }
    const template = "%{text}<br>%{x:.4~g}, %{y:.5~g} mm<br>%{z:.5~g} MPa<extra></extra>";
    drawFields("flank", flank, fields, template, { text: pairs });
  }

  function drawEnvelope({ torque, gear }) {
    const flank = data.flanks[gear], [, rows, columns] = flank.envelope.shape, step = flank.steps[torque];
    const steps = array(flank.envelope).subarray(torque * rows * columns, (torque + 1) * rows * columns);
    const value = (number) => (number === NOTHING ? null : number * step);
    const fields = range(rows).map((row) => Array.from(steps.subarray(row * columns, (row + 1) * columns), value));
    drawFields("envelope", flank, fields, "%{x:.4~g}, %{y:.5~g} mm<br>largest %{z:.5~g} MPa<extra></extra>");
  }

  function drawLineLoad({ position, torque }) {
    const traces = [];
    for (const pair of range(pairNames.length)) {
      const map = maps.at(torque, position, pair);
      if (map === null) continue;
      const slices = map.slices();
      traces.push({
        x: slices.map((slice, j) => map.onFlank(0, slice === null ? 0 : slice.middle, j)[0]),
        y: slices.map((slice) => (slice === null ? 0 : slice.load)), mode: "lines", name: pairNames[pair],
        line: { color: lineColours()[pair % lineColours().length], dash: ["solid", "dash", "dot", "dashdot"][pair % 4] },
        hovertemplate: `${literal(pairNames[pair])}<br>%{x:.4~g} mm<br>%{y:.5~g} N/mm<extra></extra>`,
      });
    }
    const more = traces.length ? { showlegend: true } : saying(EMPTY);
    Plotly.react("line-load", traces, layoutOf(more, { title: data.flanks[0].axes[0] }, { title: "line load [N/mm]", rangemode: "tozero" }), CONFIG);
  }

  function drawPanel(panel, id, { position, torque }) {
    const colours = lineColours(), at = data.angle[position];
    const lines = panel.lines.map((line, number) => ({ ...line, number })).filter((line) => line.values[torque].some((value) => value !== null));
    const traces = lines.map(({ name, values, number }) => ({
      x: data.angle, y: values[torque], name, mode: "lines+markers",
      line: { color: colours[number % colours.length], dash: ["solid", "dash", "dot", "dashdot"][number % 4] },
      marker: { size: range(data.angle.length).map((n) => (n === position ? 11 : 0)) },
      hovertemplate: `%{x:.4~g} deg<br>%{fullData.name}: %{y:.5~g} ${panel.unit}<extra></extra>`,
    }));
    const mark = { type: "line", x0: at, x1: at, y0: 0, y1: 1, yref: "paper", line: { color: colour("text"), width: 1.5 } };
    const titles = [{ title: "pinion angle [deg]" }, { title: `${panel.title.toLowerCase()} [${panel.unit}]` }];
    Plotly.react(id, traces, layoutOf({ shapes: [mark], showlegend: true, hovermode: "closest" }, ...titles), CONFIG);
    onEvent(id, "plotly_click", (event) => {
      inputs.position.value = event.points[0].pointIndex;
      redraw();
    });
  }

  const draws = { map: drawMap, flank: drawFlank, envelope: drawEnvelope, "line-load": drawLineLoad };
  data.panels.forEach((panel, index) => {
    draws[`panel-${index}`] = (at) => drawPanel(panel, `panel-${index}`, at);
  });
  if (!data.teeth.lacking) draws.space = teethIn(data, array, maps);
  const pictures = picturesOf(draws, state);
  const redraw = onceAFrame(() => {
    drawState(state());
    pictures.redraw();
  });
  Object.values(inputs).forEach((input) => input.addEventListener("input", redraw));
  drawState(state());
  return redraw;
}

/** What draws pictures, by their ids, as soon as they are in the window, and again when something changes. */
function picturesOf(draws, state) {
  const seen = new Set(), stale = new Set(Object.keys(draws));
  const drawSeen = () => seen.forEach((id) => stale.delete(id) && draws[id](state()));
  const observer = new IntersectionObserver((entries) => {
    entries.forEach(({ target, isIntersecting }) => (isIntersecting ? seen.add(target.id) : seen.delete(target.id)));
    drawSeen();
    document.documentElement.dataset.ready = "true";
  }, { rootMargin: "100px" });
  stale.forEach((id) => observer.observe(byId(id)));
  return { redraw: () => {
    Object.keys(draws).forEach((id) => stale.add(id));
    drawSeen();
  } };
}

/** Let a drawn picture tell of an event, once. */
function onEvent(id, name, run) {
  byId(id).removeAllListeners(name);
  byId(id).on(name, run);
}

/** A function that runs once a frame, however often it is asked to. */
function onceAFrame(run) {
  let waits = false;
  return () => {
    if (waits) return;
    waits = true;
    requestAnimationFrame(() => {
      waits = false;
      run();
    });
  };
}

/** What draws both teeth in space with pressure and root stress. */
function teethIn(data, array, maps) {
  const { solids, turns, origin, axes, root, lift } = data.teeth; // lift [mm]: of pressure off the pinion's tooth; the wheel's is twice as far off: else they hide each other
  const inputs = ["turn", "tilt", "zoom", "wheel-shown", "root"].map(byId).filter((input) => input !== null);
  const PINION = "#8fa3b3", WHEEL = "#c9b68a";
  const DIVERGING = [[0, "#053061"], [0.25, "#4393c3"], [0.5, "#f7f7f7"], [0.75, "#d6604d"], [1, "#67001f"]]; // blue: compression
  const points = solids.map((solid) => array(solid.vertices)), triangles = solids.map((solid) => array(solid.triangles));
  let last = null, base = null, reach = null;

  /** Coordinates x, y, z of points of a gear in space, where it is turned by an angle and moved off its place [mm]. */
  function placed(gear, values, angle, off) {
    const [cosine, sine] = [Math.cos(angle), Math.sin(angle)];
    const result = range(3).map(() => new Float64Array(values.length / 3));
    for (let n = 0; n < values.length / 3; n++) {
      const [x, y, z] = values.subarray(3 * n, 3 * n + 3), turned = [cosine * x - sine * y, sine * x + cosine * y, z];
      for (let k = 0; k < 3; k++) {
        result[k][n] = off[k] + (gear === 0 ? turned[k] : origin[k] + turned[0] * axes[0][k] + turned[1] * axes[1][k] + turned[2] * axes[2][k]);
      }
    }
    return result;
  }

  function solid(gear, angle, opacity, off) {
    const [x, y, z] = placed(gear, points[gear], angle, off);
    const [i, j, k] = range(3).map((corner) => triangles[gear].filter((_, index) => index % 3 === corner));
    const color = [PINION, WHEEL][gear];
    return { type: "mesh3d", x, y, z, i, j, k, color, opacity, flatshading: false, hoverinfo: "skip",
      lighting: { ambient: 0.75, diffuse: 0.5, specular: 0.05, roughness: 0.9 }, lightposition: lamp() };
  }

  /** A coloured surface: points [x, y, z], corners of its triangles, a number at each point. */
  function coloured(points, triangles, values, unit, more) {
    const [x, y, z] = range(3).map((k) => points.map((point) => point[k]));
    const [i, j, k] = range(3).map((corner) => triangles.map((triangle) => triangle[corner]));
    return { type: "mesh3d", x, y, z, i, j, k, intensity: values, text: values.map((value) => `${plain(value)} ${unit}`),
      lighting: { ambient: 1, diffuse: 0, specular: 0, fresnel: 0 }, flatshading: true, ...more };
  }

  /** Cells under pressure of a map, each in the colour of its own pressure. */
  function pressure(map) {
    const points = [], triangles = [], values = [];
    for (let i = 0; i < map.across; i++) {
      for (let j = 0; j < map.along; j++) {
        const value = map.value(i, j), first = points.length;
        if (value === null) continue;
        [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].forEach(([a, b]) => {
          points.push(map.inSpace(i + a, j + b, lift));
          values.push(value);
        });
        triangles.push([first, first + 1, first + 2], [first, first + 2, first + 3]);
      }
    }
    return coloured(points, triangles, values, "MPa", { cmin: 0, cmax: data.highest, colorscale: "Viridis",
      colorbar: lyingBar("contact pressure [MPa]", 0.25),
      hovertemplate: "%{text}<extra>contact pressure</extra>" });
  }

  /** Both fillets of a gear, coloured by root stress on one scale for both gears. */
  function fillets(gear, angle, off, name, torque, largest) {
    const place = root[gear].points, [sides, stations, along] = place.shape, count = sides * stations * along;
    const coordinates = placed(gear, array(place), angle, off), stress = array(root[gear][name]).subarray(torque * count, (torque + 1) * count);
    const triangles = [];
    for (let row = 0; row < sides * stations; row++) {
      if (row % stations === stations - 1) continue; // the last one of a side
      for (let first = row * along; first < (row + 1) * along - 1; first++) {
        triangles.push([first, first + along, first + along + 1], [first, first + along + 1, first + 1]);
      }
    }
    return coloured(range(count).map((n) => coordinates.map((values) => values[n])), triangles, Array.from(stress), "MPa", {
      cmin: -largest, cmax: largest, colorscale: DIVERGING, showscale: gear === 0,
      colorbar: lyingBar("root stress [MPa]", 0.75),
      hovertemplate: `%{text}<extra>root stress, ${["pinion", "wheel"][gear]}</extra>` });
  }

  /** Direction from which the pinion's flank is seen, out of it and a little from tip and heel. */
  function eyeOf(map) {
    const normal = [14, 15, 16].map((k) => map.place[k]), point = [5, 6].map((k) => map.place[k]);
    const length = Math.hypot(...point);
    return [normal[0] + 0.6 * point[0] / length, normal[1] + 0.6 * point[1] / length, normal[2] + 0.5];
  }

  /** Where the light stands: where the flank is seen from. */
  const lamp = () => Object.fromEntries(base.map((value, k) => ["xyz"[k], 1e5 * value]));

  /** Distance of the camera from which the sphere around some traces is in view, in Plotly's units: the box has the volume 1. */
  function farEnough(traces) {
    const sides = ["x", "y", "z"].map((axis) => {
      const [low, high] = traces.flatMap((trace) => Array.from(trace[axis])).reduce(([least, most], value) => [Math.min(least, value), Math.max(most, value)], [Infinity, -Infinity]);
      return high - low;
    });
    const angle = Math.PI / 8; // half the angle of view
    return 0.5 * Math.hypot(...sides) / Math.cbrt(sides[0] * sides[1] * sides[2]) / Math.sin(angle);
  }

  /** Camera after the controls: the direction, turned about z and tilted, so far away. */
  function camera() {
    const [turn, tilt] = ["turn", "tilt"].map((id) => Number(byId(id).value) * Math.PI / 180), distance = reach / Number(byId("zoom").value);
    const azimuth = Math.atan2(base[1], base[0]) + turn, limit = 0.49 * Math.PI;
    const elevation = Math.max(-limit, Math.min(limit, Math.atan2(base[2], Math.hypot(base[0], base[1])) + tilt));
    const eye = { x: distance * Math.cos(elevation) * Math.cos(azimuth), y: distance * Math.cos(elevation) * Math.sin(azimuth), z: distance * Math.sin(elevation) };
    return { eye, up: { x: 0, y: 0, z: 1 } };
  }

  function draw({ position, torque, pair }) {
    last = { position, torque, pair };
    const map = maps.at(torque, position, pair), angles = turns.map((of) => of[pair][position]);
    const axis = (title) => ({ title: { text: title }, gridcolor: colour("grid"), backgroundcolor: colour("plot"), color: colour("text"), showspikes: false, nticks: 5 });
    if (map === null || angles.includes(null)) {
      Plotly.react("space", [], layoutOf({ ...saying(`${data.pairs[pair]}: ${EMPTY}`), xaxis: { visible: false }, yaxis: { visible: false } }), CONFIG);
      return;
    }
    const wheel = Number(byId("wheel-shown").value), name = byId("root")?.value;
    base ??= eyeOf(map);
    const offs = [[0, 0, 0], [14, 15, 16].map((k) => 2 * lift * map.place[k])]; // the wheel's along the normal
    const traces = [solid(0, angles[0], 1, offs[0]), pressure(map)];
    if (wheel > 0) traces.push(solid(1, angles[1], wheel, offs[1]));
    if (name) {
      const largest = Math.max(...root.map((gear) => array(gear[name]).reduce((most, value) => Math.max(most, Math.abs(value) || 0), 0))) || 1;
      angles.forEach((angle, gear) => (gear === 1 && wheel === 0) || traces.push(fillets(gear, angle, offs[gear], name, torque, largest)));
    }
    reach ??= farEnough(traces);
    const scene = { aspectmode: "data", camera: camera(), xaxis: axis("x [mm]"), yaxis: axis("y [mm]"), zaxis: axis("z [mm]"),
      uirevision: ["turn", "tilt", "zoom"].map((id) => byId(id).value).join() };
    Plotly.react("space", traces, layoutOf({ scene, margin: { l: 0, r: 0, t: 0, b: 0 } }), CONFIG);
  }
  inputs.forEach((input) => input.addEventListener("input", onceAFrame(() => last !== null && draw(last))));
  return draw;
}

// ---------------------------------------------------------------------------------------------- a study

function drawStudy(data, array) {
  const count = data.status.length, torques = data.torques.length;
  const inputs = Object.fromEntries(["variant", "torque", "across", "upwards", "colour"].map((name) => [name, byId(name)]));
  const columns = [ // a key or a figure each: label, words of numbers, values under a torque
    ...data.keys.map(({ label, words, values }) => ({ label, words, of: () => values })),
    ...data.figures.map(({ label, values }) => {
      const all = array(values);
      return { label, words: null, of: (torque) => range(count).map((n) => (Number.isNaN(all[n * torques + torque]) ? null : all[n * torques + torque])) };
    }),
  ];
  const analysed = range(count).filter((n) => data.status[n] === "ok");
  const labels = columns.map((column) => column.label), keys = data.keys.length;
  const first = Math.min(keys, columns.length - 1);
  [["across", 0], ["upwards", first], ["colour", first]].forEach(([name, value]) => {
    fill(inputs[name], labels);
    inputs[name].value = value;
  });
  inputs.variant.value = Math.max(data.ranks.indexOf(1), 0);
  const shown = (column, value) => (value === null ? "–" : column.words === null ? plain(value) : column.words[value]);
  let kept = new Set(analysed);

  function drawNumbers({ variant }) {
    const table = document.createElement("table"), body = table.createTBody();
    const cell = (row, tag, text) => row.appendChild(Object.assign(document.createElement(tag), { textContent: text }));
    const head = table.createTHead().insertRow();
    ["", ...(torques > 1 ? data.torques : ["value"])].forEach((text) => cell(head, "th", text));
    columns.forEach((column, index) => {
      const row = body.insertRow();
      cell(row, "th", column.label);
      range(index < keys ? 1 : torques).forEach((torque) => cell(row, "td", shown(column, column.of(torque)[variant])));
    });
    const about = [data.reason[variant], ...data.warnings[variant].split("\n")].filter((text) => text !== "");
    const notes = about.map((text) => Object.assign(document.createElement("p"), { textContent: text }));
    byId("numbers").replaceChildren(...notes, table);
  }

  function drawState({ variant, torque }) {
    const rank = data.ranks[variant] === null ? "no rank" : `rank ${data.ranks[variant]} of ${analysed.length}`;
    byId("variant-shown").textContent = `${variant}: ${data.status[variant]}, ${rank}`;
    byId("torque-shown").textContent = data.torques[torque];
    inputs.variant.setAttribute("aria-valuetext", byId("variant-shown").textContent);
    inputs.torque.setAttribute("aria-valuetext", data.torques[torque]);
    const some = columns.slice(0, keys + Math.min(data.main, 4));
    byId("state").textContent = some.map((column) => `${column.label}: ${shown(column, column.of(torque)[variant])}`).join("; ");
  }

  /** Axis of a column: words where its numbers stand for some. */
  const axisOf = (column) => ({ title: column.label, ...(column.words === null ? {} : { tickvals: range(column.words.length), ticktext: column.words.map(literal) }) });

  function drawScatter({ variant, torque }) {
    const [across, upwards, coloured] = ["across", "upwards", "colour"].map((name) => columns[inputs[name].value]);
    const [x, y, values] = [across, upwards, coloured].map((column) => column.of(torque));
    const text = analysed.map((n) => `variant ${n}<br>` + [across, upwards, coloured].map((column) => `${literal(column.label)}: ${literal(shown(column, column.of(torque)[n]))}`).join("<br>"));
    const pick = (of) => analysed.map((n) => of[n]);
    const dots = { type: analysed.length > 2000 ? "scattergl" : "scatter", mode: "markers", x: pick(x), y: pick(y), customdata: analysed, text,
      hovertemplate: "%{text}<extra></extra>",
      marker: { size: 9, color: pick(values), colorscale: "Viridis", colorbar: colourBar(literal(coloured.label)), opacity: analysed.map((n) => (kept.has(n) ? 1 : 0.12)) } };
    const ring = { mode: "markers", x: [x[variant]], y: [y[variant]], hoverinfo: "skip",
      marker: { size: 17, symbol: "circle-open", color: colour("accent"), line: { width: 3, color: colour("accent") } } };
    Plotly.react("scatter", [dots, ring], layoutOf({ hovermode: "closest" }, axisOf(across), axisOf(upwards)), CONFIG);
  }

  function drawParallel({ variant, torque }) {
    const values = columns[inputs.colour.value].of(torque), known = analysed.map((n) => values[n]).filter((value) => value !== null);
    const [low, high] = [Math.min(...known), Math.max(...known)], span = high - low || 1;
    const viridis = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"].slice(dark.matches ? 2 : 0);
    const accent = colour("accent"), narrow = byId("parallel").clientWidth < 600;
    const scale = [...viridis.map((code, n) => [0.97 * n / (viridis.length - 1), code]), [0.98, accent], [1, accent]];
    const lines = analysed.map((n) => (n === variant ? 1 : 0.97 * ((values[n] ?? low) - low) / span));
    const dimensions = columns.slice(0, keys + data.main).map((column, index) => {
      const { title, ...ticks } = axisOf(column), last = byId("parallel").data?.[0].dimensions[index];
      return { label: literal(title), values: analysed.map((n) => column.of(torque)[n] ?? NaN), ...ticks, ...(last?.constraintrange && { constraintrange: last.constraintrange }) };
    });
    const trace = { type: "parcoords", dimensions, line: { color: lines, cmin: 0, cmax: 1, colorscale: scale }, labelangle: narrow ? -40 : -14, labelside: "top",
      unselected: { line: { color: colour("grid"), opacity: 0.4 } }, tickfont: { color: colour("text") }, rangefont: { color: colour("faint") } };
    Plotly.react("parallel", [trace], layoutOf({ margin: { l: 60, r: narrow ? 30 : 60, t: narrow ? 150 : 110, b: 30 } }), CONFIG);
  }

  /** Analysed variants within the ranges that the axes of the parallel coordinates keep. */
  function keptBy(dimensions) {
    return new Set(analysed.filter((_, index) => dimensions.every(({ values, constraintrange }) => {
      if (!constraintrange) return true;
      const ranges = Array.isArray(constraintrange[0]) ? constraintrange : [constraintrange];
      return ranges.some(([low, high]) => low <= values[index] && values[index] <= high);
    })));
  }

  const state = () => ({ variant: Number(inputs.variant.value), torque: Number(inputs.torque.value) });
  const nothing = (id) => () => Plotly.react(id, [], layoutOf(saying("no variant was analysed")), CONFIG);
  const draws = analysed.length === 0 ? { scatter: nothing("scatter"), parallel: nothing("parallel") } : {
    scatter: (at) => {
      drawScatter(at);
      onEvent("scatter", "plotly_click", (event) => {
        inputs.variant.value = event.points[0].customdata ?? inputs.variant.value;
        redraw();
      });
    },
    parallel: (at) => {
      drawParallel(at);
      onEvent("parallel", "plotly_restyle", () => {
        kept = keptBy(byId("parallel").data[0].dimensions);
        redraw();
      });
    },
  };
  const pictures = picturesOf(draws, state);
  const drawText = () => {
    drawState(state());
    drawNumbers(state());
  };
  const redraw = onceAFrame(() => {
    drawText();
    pictures.redraw();
  });
  Object.values(inputs).forEach((input) => input.addEventListener("input", redraw));
  drawText();
  return redraw;
}

// ---------------------------------------------------------------------------------------------- the page

const KINDS = { result: drawResult, study: drawStudy };

(async () => {
  try {
    const data = JSON.parse(byId("data").textContent);
    const redraw = KINDS[data.kind](data, await arraysOf(byId("block").textContent));
    dark.addEventListener("change", redraw);
  } catch (error) {
    byId("problem").textContent = `The pictures cannot be drawn: ${error.message}. They need a browser of 2023 or later.`;
    byId("problem").hidden = false;
    throw error;
  }
})();
