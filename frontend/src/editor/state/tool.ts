/** The tool in hand and how far its gesture has come; pure. */
import { operable } from "@/program/operation";
import type { SiteDevice } from "@/program/surroundings";

export type ToolName = string;

/** What a gesture has gathered so far. */
export interface Gesture {
  readonly tool: ToolName;
  /** Kept after use until Esc. */
  readonly locked: boolean;
  readonly source: string | null;
  readonly target: string | null;
  /** Taken by its key: devices are chosen by typing. */
  readonly byKeyboard: boolean;
}

export const RESTING: Gesture = { tool: "select", locked: false, source: null, target: null, byKeyboard: false };

/** What the gesture asks for next. */
export type Ask = "nothing" | "source" | "target" | "load" | "device" | "goal" | "floor" | "function";

export function askOf(gesture: Gesture): Ask {
  switch (gesture.tool) {
    case "select":
    case "pan":
      return "nothing";
    case "pick_and_drop":
      if (!gesture.source) return "source";
      return gesture.target ? "load" : "target";
    case "pick":
      return gesture.source ? "load" : "source";
    case "drop":
      return gesture.target ? "load" : "target";
    case "move":
      return "goal";
    case "operate":
      return "device";
    case "call":
      return "function";
    default:
      return "floor";
  }
}

/** Whether it asks for a machine or robot: the floor is no answer. */
export function asksForDevice(gesture: Gesture): boolean {
  return ["source", "target", "device"].includes(askOf(gesture));
}

/** Whether Enter sets down what the tool in hand draws, also from the list of steps. */
export function setsDownByEnter(gesture: Gesture): boolean {
  return gesture.byKeyboard && askOf(gesture) === "floor";
}

/** Take a tool; the same one twice keeps it. */
export function takeTool(gesture: Gesture, tool: ToolName, byKeyboard: boolean): Gesture {
  const again = gesture.tool === tool && tool !== "select" && tool !== "pan";
  return { ...RESTING, tool, byKeyboard, locked: again };
}

/** A press on a device that the gesture may take. */
export function withDevice(gesture: Gesture, device: string): Gesture {
  const ask = askOf(gesture);
  if (ask === "source") return { ...gesture, source: device };
  return ask === "target" && device !== gesture.source ? { ...gesture, target: device } : gesture;
}

/** One step back: the target, the source, then the tool itself. */
export function stepBack(gesture: Gesture): Gesture {
  if (gesture.target && gesture.tool === "pick_and_drop") return { ...gesture, target: null };
  if (gesture.source || gesture.target) return { ...gesture, source: null, target: null };
  return RESTING;
}

/** After a step has been made: the tool stays in hand only when it is locked. */
export function finish(gesture: Gesture): Gesture {
  return gesture.locked ? { ...RESTING, tool: gesture.tool, locked: true, byKeyboard: gesture.byKeyboard } : RESTING;
}

/** Whether a device can be what the gesture asks for. */
export function suits(gesture: Gesture, device: SiteDevice, source: SiteDevice | undefined): boolean {
  if (device.lifecycle === "pending" || (device.kind === "robot" && askOf(gesture) !== "device")) return false;
  switch (askOf(gesture)) {
    case "source":
      return device.gives.length > 0;
    case "target":
      return device.id !== gesture.source && device.takes.some((object) => !source || source.gives.includes(object));
    case "device":
      return operable(device).length > 0;
    case "goal":
      return true;
    default:
      return false;
  }
}

/** The loads to offer, likeliest first: one and two of each object that both ends know. */
export function suggestedLoads(
  source: SiteDevice | undefined,
  target: SiteDevice | undefined,
  most: number,
): readonly { quantity: number; object: string }[] {
  const given = source?.gives ?? [];
  const taken = target?.takes ?? [];
  const both = source && target ? given.filter((object) => taken.includes(object)) : [...given, ...taken];
  const objects = both.length > 0 ? both : given.length > 0 ? given : taken;
  const amounts = most > 1 ? [1, 2] : [1];
  return [...new Set(objects)].slice(0, 2).flatMap((object) => amounts.map((quantity) => ({ quantity, object })));
}
