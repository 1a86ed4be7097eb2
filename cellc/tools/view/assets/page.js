// The page: the drawing, what is shown in it, and the time line of a rehearsal. Texts of the cell are text content only.
const data = JSON.parse(document.getElementById("cell-data").textContent);
const stage = document.getElementById("stage");
function make(tag, text, parent, properties = {}) {
  const element = Object.assign(document.createElement(tag), properties);
  element.textContent = text;
  parent.append(element);
  return element;
}

class Labels {
  constructor(place, camera) {
    this.place = place;
    this.camera = camera;
    this.shown = [];
  }

  set(objects) {
    this.place.replaceChildren();
    this.shown = objects.map((object) => ({ object, element: make("span", object.userData.label, this.place) }));
    for (const one of this.shown) one.size = [one.element.offsetWidth, one.element.offsetHeight];
  }

  // Nearer frames first; a label that would lie on another one is left out until the view is turned.
  update(width, height) {
    const taken = [];
    const spot = new THREE.Vector3();
    const depths = this.shown.map((one) => {
      one.at = one.object.getWorldPosition(spot).clone().project(this.camera);
      return one;
    });
    for (const one of depths.sort((a, b) => a.at.z - b.at.z)) {
      const x = ((one.at.x + 1) / 2) * width + 6;
      const y = ((1 - one.at.y) / 2) * height + 4;
      const [wide, high] = one.size;
      const box = [x, y, x + wide, y + high];
      const hit = taken.some((other) => box[0] < other[2] && box[2] > other[0] && box[1] < other[3] && box[3] > other[1]);
      const out = one.at.z > 1 || x < 0 || y < 0 || box[2] > width || box[3] > height;
      one.element.hidden = hit || out;
      if (one.element.hidden) continue;
      one.element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      taken.push(box);
    }
  }
}

class Drawing {
  constructor(place) {
    this.place = place;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.outputEncoding = THREE.sRGBEncoding;
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "The cell in 3D; arrow keys turn it, + and - go nearer and away");
    this.copy = document.createElement("canvas");
    this.copy.className = "copy";
    place.prepend(this.canvas, this.copy);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(24, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.model = new CellModel(data.scene);
    const before = data.before && (data.before.meshes.length ? data.before : { ...data.before, meshes: data.scene.meshes });
    const other = before || (data.runs.some((run) => run.ghost) ? data.scene : null);
    this.ghost = other ? new CellModel(other, { ghost: true }) : null;
    const light = new THREE.DirectionalLight("#ffffff", 0.7);
    light.position.set(0.4, 0.8, 1);
    this.camera.add(light);
    this.scene.add(this.camera, this.model.root, new THREE.HemisphereLight("#ffffff", "#8d97a3", 0.6));
    if (this.ghost) {
      this.scene.add(this.ghost.root);
      this.ghost.hideSame(this.model);
    }
    this.labels = new Labels(place.querySelector(".labels"), this.camera);
    for (const name of ["pointerdown", "wheel", "keydown"]) {
      this.canvas.addEventListener(name, () => { this.turned = true; });
    }
    this.orbit = new Orbit(this.camera, this.canvas, () => this.request());
    this.floor();
    this.fit();
    new ResizeObserver(() => this.resize()).observe(place);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.floor());
    window.addEventListener("beforeprint", () => this.print(true));
    window.addEventListener("afterprint", () => this.print(false));
    this.pick(place.querySelector(".picked"));
    this.resize();
  }

  floor(paper = false) {
    this.scene.remove(this.grid);
    const half = Math.max(1, Math.ceil(this.model.sphere.radius * 1.6));
    const color = paper ? "#d9dee4" : getComputedStyle(document.documentElement).getPropertyValue("--rule").trim();
    this.grid = new THREE.GridHelper(half * 2, half * 4, color, color).rotateX(Math.PI / 2);
    this.scene.add(this.grid);
    this.request();
  }

  // As near as all corners of the cell are seen, and in the middle: the camera looks along `back`, so that
  // a corner is within the picture where its distance from the axis is at most slope times its distance from the camera.
  fit() {
    const { orbit, camera, model: { sphere } } = this;
    orbit.target.copy(sphere.center);
    orbit.place();
    const [right, up, back] = [0, 1, 2].map((column) => new THREE.Vector3().setFromMatrixColumn(camera.matrix, column));
    const tangent = Math.tan((camera.fov * Math.PI) / 360);
    const aspect = this.place.clientWidth / Math.max(1, this.place.clientHeight);
    const corners = [this.model, this.ghost].flatMap((model) => model?.corners() ?? []);
    const distances = [[right, tangent * aspect], [up, tangent]].map(([axis, slope]) => {
      const ends = [1, -1].map((sign) => Math.max(...corners.map((corner) => {
        const away = corner.clone().sub(sphere.center);
        return sign * away.dot(axis) + slope * away.dot(back);
      })));
      orbit.target.addScaledVector(axis, (ends[0] - ends[1]) / 2);
      return (ends[0] + ends[1]) / 2 / slope;
    });
    orbit.distance = Math.max(...distances) * 1.15;
    orbit.place();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.turned) this.fit(); // a phone that is turned, before anybody moved the cell
    this.request();
  }

  request() {
    this.due ||= requestAnimationFrame(() => {
      this.due = 0;
      this.draw();
      document.documentElement.dataset.drawn ||= Math.round(performance.now());
    });
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
    this.labels.update(this.place.clientWidth, this.place.clientHeight);
  }

  // On paper the cell is as wide as the page, whose width is unknown before it is printed; browsers print what a canvas
  // of this kind showed before, so that its picture is copied to one of the other kind.
  print(paper) {
    this.place.classList.toggle("paper", paper);
    this.floor(paper);
    this.resize();
    this.draw();
    const { width, height } = this.canvas;
    Object.assign(this.copy, { width, height });
    this.copy.getContext("2d").drawImage(this.canvas, 0, 0);
  }

  show(layers, named) {
    const labeled = [];
    for (const [name, marks] of Object.entries(this.model.layers)) {
      for (const mark of marks) mark.visible = layers.has(name);
      if (layers.has(name)) labeled.push(...marks);
    }
    if (this.ghost) this.ghost.root.visible = layers.has("before") || layers.has("ghost");
    this.labels.set(named ? labeled : []);
    this.request();
  }

  pose(name) {
    for (const model of [this.model, this.ghost]) {
      const numbers = model?.postures.get(name);
      if (numbers) model.stand(numbers);
    }
    this.ghost?.hideSame(this.model);
    this.request();
  }

  pick(words) {
    const caster = new THREE.Raycaster();
    let down = null;
    this.canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
    this.canvas.addEventListener("pointerup", (event) => {
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
      const box = this.canvas.getBoundingClientRect();
      caster.setFromCamera({ x: ((event.clientX - box.left) / box.width) * 2 - 1,
        y: 1 - ((event.clientY - box.top) / box.height) * 2 }, this.camera);
      const hit = caster.intersectObjects(this.model.bodies, false)[0];
      words.textContent = hit ? hit.object.userData.words : "";
    });
  }
}

class Player {
  constructor(place, drawing) {
    this.drawing = drawing;
    [this.line, this.lower] = place.querySelectorAll(".line");
    this.slider = place.querySelector("input");
    this.button = place.querySelector("button");
    this.marks = place.querySelector(".marks");
    this.words = place.querySelector(".status");
    this.choice = place.querySelector("select");
    data.runs.forEach((run, number) => make("option", run.name, this.choice, { value: number }));
    this.choice.addEventListener("change", () => this.choose(Number(this.choice.value)));
    this.slider.addEventListener("input", () => { this.stop(); this.go(Number(this.slider.value)); });
    this.button.addEventListener("click", () => (this.playing ? this.stop() : this.play()));
    for (const link of document.querySelectorAll("[data-run]")) {
      link.addEventListener("click", () => {
        this.choose(Number(link.dataset.run));
        if (link.dataset.at) this.go(Number(link.dataset.at));
        else this.play();
        stage.scrollIntoView({ block: "nearest" });
      });
    }
    const found = dynamicFrames();
    this.links = data.scene.groups.flatMap((name, number) => (found.has(name) ? [] : [number]));
    this.choose(0, data.runs[0].recorded);
  }

  choose(number, shown = true) {
    this.stop();
    this.run = data.runs[number];
    this.choice.value = number;
    this.playback = new Playback(this.run);
    this.beside = this.run.ghost ? new Playback(data.runs[this.run.ghost.run]) : null;
    this.marked = [...this.run.faults, ...(this.run.ghost ? this.run.ghost.marks : [])];
    this.from = this.run.moments.length ? Math.max(0, this.run.moments[0].from_s - 0.2) : 0;
    Object.assign(this.slider, { min: this.from, max: this.run.end_s, step: 0.01 });
    this.slider.disabled = this.button.disabled = !this.run.times.length;
    this.fill(this.line, this.run.moments, 0);
    for (const fault of this.marked) {
      const mark = make("i", "", this.line, { className: "fault", title: `${fault.name} at ${fault.at_s.toFixed(2)} s` });
      mark.style.left = this.share(Math.max(this.from, fault.at_s));
    }
    if (this.lower) {
      this.lower.hidden = !this.beside;
      this.fill(this.lower, this.beside ? this.beside.run.moments : [], this.beside ? this.run.ghost.shift_s : 0);
    }
    this.nameFaults();
    this.time = this.from;
    this.slider.value = this.from;
    if (shown) this.go(this.from);
    else this.tell();
  }

  share(time) {
    return `${(100 * (time - this.from)) / Math.max(1e-9, this.run.end_s - this.from)}%`;
  }

  // Steps of a run on the time line, darker while a controller executes a goal.
  fill(line, moments, shift) {
    line.replaceChildren();
    for (const moment of moments) {
      const wide = (moment.until_s - moment.from_s) / (this.run.end_s - this.from) > 0.08;
      const span = make("span", "", line);
      span.className = { succeeded: "step", UNKNOWN: "step unknown" }[moment.outcome] || "step bad";
      span.title = `${moment.name}: ${moment.outcome}${moment.reason ? `, ${moment.reason}` : ""}`;
      span.style.left = this.share(moment.from_s + shift);
      span.style.width = `calc(${this.share(moment.until_s)} - ${this.share(moment.from_s)})`;
      if (moment.works.length) {
        const [begin, end] = moment.works.map((at) => (100 * (at - moment.from_s)) / Math.max(1e-9, moment.until_s - moment.from_s));
        Object.assign(make("i", "", span, { className: "works" }).style, { left: `${begin}%`, width: `${end - begin}%` });
      }
      if (wide) make("b", moment.name, span);
    }
  }

  // Each under its mark, or a row lower where another name is.
  nameFaults() {
    this.marks.replaceChildren();
    const wide = this.marks.clientWidth || 1, rows = [];
    for (const fault of this.marked) {
      const name = make("span", fault.name, this.marks);
      const at = (wide * (fault.at_s - this.from)) / Math.max(1e-9, this.run.end_s - this.from);
      const late = at + name.offsetWidth > wide;
      const left = late ? Math.max(0, at - name.offsetWidth) : at;
      name.classList.toggle("late", late);
      const free = rows.findIndex((end) => end < left);
      const row = free < 0 ? rows.length : free;
      rows[row] = left + name.offsetWidth + 8;
      Object.assign(name.style, { left: `${(100 * left) / wide}%`, top: `${15 * row}px` });
    }
    this.marks.style.height = `${15 * rows.length}px`;
  }

  play() {
    if (!this.run.times.length) return;
    if (this.time >= this.run.end_s - 0.01) this.time = this.from;
    this.playing = true;
    this.button.textContent = "Pause";
    let last = performance.now();
    const tick = (now) => {
      if (!this.playing) return;
      this.go(Math.min(this.run.end_s, this.time + (now - last) / 1000));
      last = now;
      if (this.time >= this.run.end_s) this.stop();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  stop() {
    this.playing = false;
    this.button.textContent = "Play";
  }

  go(time) {
    this.time = time;
    this.slider.value = time;
    this.playback.show(this.drawing.model, time);
    if (this.drawing.ghost && !data.before) {
      // Where nothing is beside a run, the ghost is where the run is, and hidden there.
      (this.beside || this.playback).show(this.drawing.ghost, time - (this.beside ? this.run.ghost.shift_s : 0));
      this.drawing.ghost.hideSame(this.drawing.model, 2e-3, 1e-2);
    }
    this.drawing.request();
    this.tell();
  }

  tell() {
    const { faults, outcome, reason, end_s: end, ghost } = this.run;
    const parts = [`${this.time.toFixed(2)} s`, ...stepAt(this.run, this.time)];
    const active = faults.filter((one) => one.at_s <= this.time).map((one) => one.name);
    if (active.length) parts.push(`fault: ${active.join(", ")}`);
    if (this.time >= end - 0.01) parts.push(reason ? `${outcome}: ${reason}` : outcome);
    this.words.replaceChildren();
    parts.join(" · ").split("`").forEach((part, at) => make(at % 2 ? "code" : "span", part, this.words));
    if (!ghost) return;
    const other = data.runs[ghost.run], time = this.time - ghost.shift_s;
    const beside = [`${ghost.name}: ${time.toFixed(2)} s`, ...stepAt(other, time), this.apart()];
    if (time >= other.end_s - 0.01) beside.splice(1, beside.length - 2, other.outcome);
    make("span", beside.join(" · "), this.words, { className: "ghost" });
  }

  // Which link is farthest from its ghost now.
  apart() {
    const [model, ghost] = [this.drawing.model.groups, this.drawing.ghost.groups];
    const far = this.links.map((number) => [model[number].position.distanceTo(ghost[number].position), number]);
    const [most, number] = far.reduce((one, other) => (other[0] > one[0] ? other : one), [0, 0]);
    return most < 5e-4 ? "together" : `${(1000 * most).toFixed(0)} mm apart at ${data.scene.groups[number]}`;
  }
}

function dynamicFrames() {
  return new Set(data.scene.frames.filter((one) => one.kind === "dynamic").map((one) => one.name));
}

// Step and phase of a run at a time, in words.
function stepAt({ moments }, time) {
  const number = moments.findLastIndex((one) => one.from_s <= time);
  if (number < 0) return [];
  const { name, phases, until_s: until } = moments[number];
  const words = [`step ${number + 1} of ${moments.length}, ${name}`];
  const phase = phases.findLast((one) => one.at_s <= time);
  return phase && time <= until + 0.005 ? [...words, phase.name.slice(2)] : words;
}

function start() {
  const drawing = new Drawing(stage.querySelector(".drawing"));
  const boxes = [...stage.querySelectorAll("[data-layer]")];
  const show = () => {
    const layers = new Set(boxes.filter((box) => box.checked).map((box) => box.dataset.layer));
    drawing.show(layers, layers.has("names"));
  };
  boxes.forEach((box) => box.addEventListener("change", show));
  // Front and side are those of the picture from two sides: along y, and against x.
  const looks = { around: [-0.9, 0.45], front: [-Math.PI / 2, 0], side: [0, 0], above: [-Math.PI / 2, 1.55] };
  for (const button of stage.querySelectorAll("[data-look]")) {
    button.addEventListener("click", () => {
      drawing.orbit.look(...looks[button.dataset.look]);
      drawing.fit();
    });
  }
  const poses = stage.querySelector(".poses");
  for (const { name } of data.scene.poses) {
    make("button", name, poses, { type: "button" }).addEventListener("click", () => { player?.stop(); drawing.pose(name); });
  }
  legend(drawing);
  const place = stage.querySelector(".player");
  place.hidden = !data.runs.length;
  const player = data.runs.length ? new Player(place, drawing) : null;
  show();
}

function legend(drawing) {
  const place = stage.querySelector(".legend");
  const { devices, kinds } = data.scene;
  const alike = devices.length > 1 && new Set(kinds).size === 1;
  const add = (color, name, kind) => {
    const entry = make("span", "", place);
    make("i", "", entry).style.background = `#${color.getHexString()}`;
    entry.append(name);
    if (kind) make("small", kind, entry);
  };
  devices.forEach((name, number) => add(drawing.model.colors.get(name), name, alike ? "" : kinds[number]));
  if (drawing.ghost) add(GHOST_COLOR, data.before ? "its pose before" : `ghost: ${data.runs[0].ghost.name}`);
  if (alike) make("small", `all drawn as ${kinds[0]}`, place);
  if (data.scene.parts.length) add(new THREE.Color(PART_COLOR), "part");
}

if (data.scene && window.THREE && document.createElement("canvas").getContext("webgl")) {
  stage.classList.add("ready");
  start();
}
