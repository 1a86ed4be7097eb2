// The page's data as objects of three.js. Every pose is given; nothing is computed but where lines end.
THREE.ColorManagement.legacyMode = false;
const POSE = 7;
const AXES = [[[1, 0, 0], "#d64545"], [[0, 1, 0], "#2f9e5b"], [[0, 0, 1], "#2f6fd6"]];
const SCENE_COLOR = "#a9b0b9";
const PART_COLOR = "#c9962b";
const GHOST_COLOR = new THREE.Color("#d0762a");

function deviceColor(number) {
  return new THREE.Color().setHSL(((212 + number * 137.5) % 360) / 360, number ? 0.32 : 0.2, 0.55);
}

function placeAt(object, numbers, offset = 0) {
  object.position.fromArray(numbers, offset);
  object.quaternion.fromArray(numbers, offset + 3).normalize();
}

const makeGeometry = {
  box: ([x, y, z]) => new THREE.BoxGeometry(x, y, z),
  cylinder: ([radius, length]) => new THREE.CylinderGeometry(radius, radius, length, 32).rotateX(Math.PI / 2),
  sphere: ([radius]) => new THREE.SphereGeometry(radius, 28, 18),
};

// Whole numbers of 16 bits, as base64.
function unpacked(text) {
  return new Uint16Array(Uint8Array.from(atob(text), (one) => one.charCodeAt(0)).buffer);
}

function meshGeometry({ low, step, vertices, triangles }) {
  const numbers = Float32Array.from(unpacked(vertices), (one, at) => low[at % 3] + step * one);
  return new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(numbers, 3))
    .setIndex(new THREE.BufferAttribute(unpacked(triangles), 1));
}

class CellModel {
  constructor(data, { ghost = false } = {}) {
    this.meshes = data.meshes.map(meshGeometry);
    this.root = new THREE.Group();
    this.groups = data.groups.map(() => new THREE.Group());
    this.root.add(...this.groups);
    this.colors = new Map(data.devices.map((name, number) => [name, deviceColor(number)]));
    this.bodies = [];
    this.postures = new Map(data.poses.map((pose) => [pose.name, pose.groups]));
    for (const shape of data.shapes) this.addShape(shape, ghost, SCENE_COLOR);
    this.parts = data.parts.map((part) => this.addShape(part, ghost, PART_COLOR));
    if (data.poses.length) this.stand(data.poses[0].groups);
    this.root.updateMatrixWorld(true);
    this.box = new THREE.Box3();
    for (const body of this.near()) this.box.expandByObject(body);
    if (this.box.isEmpty()) this.box.setFromCenterAndSize(new THREE.Vector3(), new THREE.Vector3(1, 1, 1));
    this.sphere = this.box.getBoundingSphere(new THREE.Sphere());
    this.layers = ghost ? {} : {
      frames: this.marks(data.frames.filter((one) => one.kind !== "link"), (one) => this.triad(one, 1)),
      links: this.marks(data.frames.filter((one) => one.kind === "link"), (one) => this.triad(one, 0.7)),
      goals: this.marks(data.goals, (one) => this.goal(one)),
      cones: this.marks(data.cones, (one) => this.cone(one)),
    };
  }

  addShape(shape, ghost, own) {
    const meshed = shape.kind === "mesh";
    const geometry = meshed ? this.meshes[shape.size[0]] : makeGeometry[shape.kind](shape.size);
    const color = ghost ? GHOST_COLOR : this.colors.get(shape.owner) || new THREE.Color(own);
    // Where both surfaces are in one place, that of the ghost is behind.
    const look = { color, transparent: ghost, opacity: ghost ? 0.28 : 1, depthWrite: !ghost, polygonOffset: ghost,
      polygonOffsetFactor: 4, polygonOffsetUnits: 4 };
    const body = new THREE.Mesh(geometry, meshed
      ? new THREE.MeshPhongMaterial({ ...look, flatShading: true, specular: 0 })
      : new THREE.MeshLambertMaterial(look));
    if (!meshed) {
      body.add(new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 30),
        new THREE.LineBasicMaterial({ color: color.clone().multiplyScalar(0.4), transparent: true, opacity: 0.6 })));
    }
    body.userData.owner = shape.owner;
    body.userData.words = shape.owner ? `${shape.owner}: ${shape.link}` : shape.link;
    placeAt(body, shape.pose);
    this.groups[shape.group].add(body);
    this.bodies.push(body);
    return body;
  }

  marks(all, draw) {
    return all.map((one) => {
      const mark = draw(one);
      placeAt(mark, one.pose);
      mark.userData.label = one.name;
      this.groups[one.group].add(mark);
      return mark;
    });
  }

  // All bodies but those that are far larger than the devices together, such as a floor.
  near() {
    const devices = new THREE.Box3(), box = new THREE.Box3(), size = new THREE.Vector3();
    for (const body of this.bodies) if (body.userData.owner) devices.expandByObject(body);
    const most = devices.isEmpty() ? Infinity : 3 * devices.getSize(size).length();
    return this.bodies.filter((body) => box.setFromObject(body).getSize(size).length() < most);
  }

  // Of the bodies that are seen, and where frames and goals stand; what is far off leaves the rest large.
  corners() {
    this.root.updateMatrixWorld(true);
    const all = this.near().filter((body) => body.visible).flatMap((body) => {
      if (!body.geometry.boundingBox) body.geometry.computeBoundingBox();
      const { min, max } = body.geometry.boundingBox;
      return [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => new THREE.Vector3(
        bits & 1 ? max.x : min.x, bits & 2 ? max.y : min.y, bits & 4 ? max.z : min.z).applyMatrix4(body.matrixWorld));
    });
    const marks = [...(this.layers.frames || []), ...(this.layers.goals || [])];
    const near = marks.map((mark) => mark.getWorldPosition(new THREE.Vector3()))
      .filter((place) => place.distanceTo(this.sphere.center) < 2 * this.sphere.radius);
    return all.length + near.length ? [...all, ...near] : [this.box.min, this.box.max];
  }

  get unit() {
    return Math.max(0.04, Math.min(0.25, this.sphere.radius * 0.08));
  }

  triad(one, scale) {
    const mark = new THREE.Group();
    const long = this.unit * scale;
    for (const [axis, color] of AXES) {
      const bar = new THREE.Mesh(new THREE.CylinderGeometry(long * 0.035, long * 0.035, long, 8).translate(0, long / 2, 0),
        new THREE.MeshBasicMaterial({ color, depthTest: false, transparent: true }));
      bar.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), new THREE.Vector3(...axis));
      bar.renderOrder = 2;
      mark.add(bar);
    }
    return mark;
  }

  goal(one) {
    const mark = this.triad(one, 0.6);
    if (!one.approach.length) return mark;
    const from = new THREE.Vector3(...one.approach);
    const arrow = new THREE.ArrowHelper(from.clone().negate().normalize(), from, from.length(), "#8a4fbf",
      from.length() * 0.3, from.length() * 0.16);
    for (const part of [arrow.line, arrow.cone]) Object.assign(part.material, { depthTest: false, transparent: true });
    for (const part of [arrow.line, arrow.cone]) part.renderOrder = 2;
    mark.add(arrow);
    return mark;
  }

  cone(one) {
    const [near, far] = [one.depths[0], Math.min(one.depths[1], this.sphere.radius)];
    const [right, up] = one.angles.map((angle) => Math.tan(angle / 2));
    const corner = (z, x, y) => [x * right * z, y * up * z, z];
    const ring = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
    const lines = [], faces = [];
    ring.forEach(([x, y], number) => {
      const [x2, y2] = ring[(number + 1) % 4];
      lines.push(...corner(near, x, y), ...corner(far, x, y), ...corner(far, x, y), ...corner(far, x2, y2));
      lines.push(...corner(near, x, y), ...corner(near, x2, y2));
      faces.push(0, 0, 0, ...corner(far, x, y), ...corner(far, x2, y2));
    });
    const buffer = (numbers) => new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(numbers, 3));
    const mark = new THREE.Group();
    mark.add(new THREE.LineSegments(buffer(lines), new THREE.LineBasicMaterial({ color: "#b8860b" })));
    mark.add(new THREE.Mesh(buffer(faces), new THREE.MeshBasicMaterial({
      color: "#e0a81f", transparent: true, opacity: 0.1, side: THREE.DoubleSide, depthWrite: false })));
    return mark;
  }

  // Of a ghost, only what is elsewhere is shown, by so many m or rad.
  hideSame(other, far = 2e-4, turned = 2e-3) {
    const key = (body, number) => `${body.userData.words} ${number}`;
    const known = new Map(other.bodies.map((body, number) => [key(body, number - other.firstOf(body)), body]));
    const [spot, place] = [new THREE.Vector3(), new THREE.Vector3()];
    const [turn, way] = [new THREE.Quaternion(), new THREE.Quaternion()];
    for (const model of [this, other]) model.root.updateMatrixWorld(true);
    this.bodies.forEach((body, number) => {
      const now = known.get(key(body, number - this.firstOf(body)));
      body.visible = !now || body.getWorldPosition(spot).distanceTo(now.getWorldPosition(place)) > far
        || body.getWorldQuaternion(turn).angleTo(now.getWorldQuaternion(way)) > turned;
    });
  }

  firstOf(body) {
    return this.bodies.findIndex((one) => one.userData.words === body.userData.words);
  }

  stand(numbers) {
    this.groups.forEach((group, number) => placeAt(group, numbers, number * POSE));
  }
}

// Pose of every group at a time of a run: between two pictures along the straight line and the shorter arc.
class Playback {
  constructor(run) {
    this.run = run;
  }

  show(model, time) {
    const { times, base, tracks } = this.run;
    if (!times.length) return;
    let after = times.findIndex((one) => one > time);
    if (after < 0) after = times.length - 1;
    const before = Math.max(0, after - 1);
    const span = times[after] - times[before];
    const share = span > 0 ? Math.min(1, Math.max(0, (time - times[before]) / span)) : 1;
    model.stand(base);
    for (const part of model.parts) part.visible = !this.run.recorded;  // no bag says where it is
    for (const { group, poses } of tracks) {
      const object = model.groups[group];
      const end = new THREE.Group();
      placeAt(object, poses, before * POSE);
      placeAt(end, poses, after * POSE);
      object.position.lerp(end.position, share);
      object.quaternion.slerp(end.quaternion, share);
    }
  }
}
