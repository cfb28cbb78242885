// Hands of the emulator push and grab, and anchors move: what the AR test asks for by name.
import { frames, state } from './ar_emulator.mjs';

/** A joint of the right hand; null: it is not seen. For use within a frame. */
const jointAt = (name) => {
  const { frame, ar } = state.last;
  const source = [...ar.session.inputSources].find(({ hand, handedness }) => hand && handedness === 'right');
  const m = source && frame.getJointPose(source.hand.get(name), ar.space)?.transform.matrix;
  return m ? [m[12], m[13], m[14]] : null;
};

/** Moves the right hand so that a joint is at a place after the next frames. */
async function moveHand(name, place, count = 12) {
  const { position } = state.device.hands.right;
  let from = null;
  await frames(9, () => { from = jointAt(name); return from !== null; });
  const start = [position.x, position.y, position.z];
  for (let i = 1; i <= count; i++) {
    position.set(...start.map((x, k) => x + ((place[k] - from[k]) * i) / count));
    await frames(1);
  }
}

/** A ball on the table or floor before the head, a hand that comes at it, and one that takes and lifts it. */
export async function touch(place) {
  const { relief, ar, device } = state;
  ar.see.bodies().forEach(({ id }) => ar.see.remove(id));
  relief.setGravity(0, -9.81, 0);
  device.primaryInputMode = 'hand';
  device.hands.right.position.set(place[0] + 0.3, place[1] + 0.3, place[2]);
  device.hands.left.position.set(place[0] - 2, place[1] + 0.5, place[2]);
  ar.see.addBody({ shape: 'sphere', size: [0.05], position: place, restitution: 0.1, friction: 0.9 });
  await frames(25);
  const ball = () => [...ar.see.bodies()[0].position];
  const out = { handsSeen: ar.handsSeen, before: ball() };
  await moveHand('index-finger-tip', [out.before[0] + 0.15, out.before[1], out.before[2]]);
  await moveHand('index-finger-tip', [out.before[0] - 0.05, out.before[1], out.before[2]]);
  out.pushed = ball();
  await moveHand('index-finger-tip', [out.pushed[0] + 0.2, out.pushed[1] + 0.3, out.pushed[2]], 4);
  await frames(20);
  out.rested = ball();
  device.hands.right.updatePinchValue(1);
  await moveHand('index-finger-tip', [out.rested[0], out.rested[1] + 0.5, out.rested[2]], 6);
  device.hands.right.updatePinchValue(0);
  await frames(3);
  out.balls = ar.see.bodies().length; // a pinch in the air makes one
  ar.see.bodies().slice(1).forEach(({ id }) => ar.see.remove(id));
  await moveHand('index-finger-tip', [out.rested[0] + 0.3, out.rested[1] + 0.2, out.rested[2]], 6);
  await frames(20);
  out.again = ball();
  await moveHand('thumb-tip', [out.again[0] + 0.03, out.again[1] + 0.06, out.again[2]], 3);
  device.hands.right.updatePinchValue(1);
  await frames(2);
  await moveHand('thumb-tip', [out.again[0], out.again[1] + 0.4, out.again[2]], 15);
  out.lifted = ball();
  device.hands.right.updatePinchValue(0);
  await frames(25);
  out.dropped = ball();
  return out;
}

/** Bodies that rest have anchors; one that the device moves takes its body along. */
export async function anchoring() {
  const { ar } = state;
  await frames(60, () => ar.see.bodies().every(({ isAsleep }) => isAsleep));
  await frames(4);
  await frames(3, ({ frame }) => {
    state.anchorSpaces = new Set([...frame.trackedAnchors].map((anchor) => anchor.anchorSpace));
    return state.anchorSpaces.size > 0;
  });
  const [before] = ar.see.bodies();
  const { getPose } = XRFrame.prototype;
  XRFrame.prototype.getPose = function moved(space, base) {
    const pose = getPose.call(this, space, base);
    if (!state.anchorSpaces.has(space)) return pose;
    const { position: p, orientation: q } = pose.transform;
    return { transform: new XRRigidTransform({ x: p.x + 0.05, y: p.y, z: p.z, w: 1 }, q) };
  };
  await frames(2);
  XRFrame.prototype.getPose = getPose;
  const [after] = ar.see.bodies();
  const way = after.position.map((x, k) => x - before.position[k]);
  return { count: ar.anchors.count, moved: ar.anchors.moved, asleep: before.isAsleep, way };
}
