// A camera that circles a point, z up: drag turns, two fingers or the right button shift, wheel and pinch go nearer.
class Orbit {
  constructor(camera, element, changed) {
    this.camera = camera;
    this.changed = changed;
    this.target = new THREE.Vector3();
    this.distance = 3;
    this.azimuth = -0.9;
    this.elevation = 0.45;
    this.pointers = new Map();
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, event);
    });
    for (const name of ["pointerup", "pointercancel"]) {
      element.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    }
    element.addEventListener("pointermove", (event) => this.moved(event, element));
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    element.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 120) * 0.0015));
    }, { passive: false });
    element.addEventListener("keydown", (event) => this.pressed(event));
  }

  moved(event, element) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const size = element.clientHeight || 1;
    const dx = (event.clientX - before.clientX) / size;
    const dy = (event.clientY - before.clientY) / size;
    if (this.pointers.size === 2) {
      const other = [...this.pointers.values()].find((one) => one.pointerId !== event.pointerId);
      const apart = (one) => Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY) || 1;
      this.pan(dx / 2, dy / 2);
      this.zoom(apart(before) / apart(event));
    } else if (event.buttons === 2 || event.shiftKey) {
      this.pan(dx, dy);
    } else {
      this.turn(-dx * 4, dy * 4);
    }
    this.pointers.set(event.pointerId, event);
  }

  pressed(event) {
    const turns = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
    const zooms = { "+": 0.9, "=": 0.9, "-": 1.1 };
    if (turns[event.key]) this.turn(...turns[event.key]);
    else if (zooms[event.key]) this.zoom(zooms[event.key]);
    else return;
    event.preventDefault();
  }

  turn(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.max(-1.55, Math.min(1.55, this.elevation + elevation));
    this.place();
  }

  pan(dx, dy) {
    const span = 2 * this.distance * Math.tan((this.camera.fov * Math.PI) / 360);
    const axes = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
    this.camera.matrix.extractBasis(...axes);
    this.target.addScaledVector(axes[0], -dx * span).addScaledVector(axes[1], dy * span);
    this.place();
  }

  zoom(factor) {
    this.distance = Math.max(0.05, Math.min(200, this.distance * factor));
    this.place();
  }

  look(azimuth, elevation) {
    this.azimuth = azimuth;
    this.elevation = elevation;
    this.place();
  }

  place() {
    const flat = Math.cos(this.elevation);
    const away = new THREE.Vector3(
      flat * Math.cos(this.azimuth), flat * Math.sin(this.azimuth), Math.sin(this.elevation));
    this.camera.position.copy(this.target).addScaledVector(away, this.distance);
    this.camera.lookAt(this.target);
    this.camera.near = this.distance / 100;
    this.camera.far = this.distance * 20 + 50;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrix();
    this.changed();
  }
}
