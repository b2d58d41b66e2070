/** What can be drawn at a place: what the device there can do comes first, then all constructs and functions. */
import i18next from "i18next";
import type { Box } from "@/map/plane/projection";
import { operable } from "@/program/operation";
import { deviceBox, type Method, type SiteDevice } from "@/program/surroundings";
import { wordsOf } from "@/shell/palette/search";
import { createStep } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { drawAt } from "../state/drawAt";
import { freeSpot, openEnds } from "../state/freeSpot";
import { createAtDevice, operatedBy } from "../state/newStep";
import { spotOnMachine } from "../state/placement";
import { RESTING, takeTool } from "../state/tool";
import { TOOLS } from "../state/tools";
import type { Under } from "../state/under";
import { useUi } from "../state/ui";
import { type Command, vipoIcon } from "./command";
import { type Named, wordsOfName } from "./sentence";

export interface Drawable extends Named {
  readonly name: string;
  readonly about: string;
  readonly icon: Command["icon"];
  /** The key that draws it, too. */
  readonly tool?: string;
  /** The step, or its tool in hand where more must be chosen. */
  readonly draw: (open: OpenProgram, under: Under) => void;
}

/** Reads a text of the catalogues. */
type Words = (key: string) => string;

function boxes({ scene }: OpenProgram): Box[] {
  return [...[...scene.chips.values()].map((chip) => chip.box), ...openEnds(scene)];
}

/** What one device can do in a program. */
export function drawablesOf(device: SiteDevice, other: Words): Drawable[] {
  const ways: [kind: string, possible: boolean][] = [
    ["pick_and_drop", device.kind !== "robot" && device.gives.length > 0],
    ["drop", device.kind !== "robot" && device.takes.length > 0],
    ["pick", device.kind !== "robot" && device.gives.length > 0],
    ["move", device.kind !== "robot"],
  ];
  const methods = operable(device).map((method) => methodDrawable(device, method, other));
  const kinds = ways.flatMap(([kind, possible]) => (possible ? [kindAt(kind, device, other)] : []));
  return device.lifecycle === "pending" ? [] : [...methods, ...kinds];
}

function methodDrawable(device: SiteDevice, method: Method, other: Words): Drawable {
  return {
    id: `method:${method.name}`,
    name: method.title || method.name,
    about: i18next.t("commands.quick.method", { device: device.name }),
    icon: vipoIcon("operate"),
    words: [...wordsOfName(method.name), ...wordsOf(method.title ?? ""), ...toolWords("operate", other)],
    draw: (open) => {
      const pos = spotOnMachine(deviceBox(device), boxes(open));
      const params = { device: operatedBy(open.document, device), method: method.name, args: {} };
      createStep(open.document, open.apply, { kind: "operate", pos, params });
    },
  };
}

function kindAt(kind: string, device: SiteDevice, other: Words): Drawable {
  const icon = TOOLS.find((each) => each.kind === kind)?.icon ?? "";
  return {
    id: `here:${kind}`,
    name: i18next.t(`commands.quick.${kind}`),
    about: i18next.t(`editor.about.${kind}`),
    icon: vipoIcon(icon),
    words: toolWords(kind, other),
    draw: (open) => {
      const gesture = takeTool(RESTING, kind, false);
      useUi.setState({ gesture });
      createAtDevice(open, gesture, device, boxes(open));
    },
  };
}

/** All constructs, and the functions of the program. */
export function drawablesAnywhere({ document }: OpenProgram, other: Words): Drawable[] {
  const kinds = TOOLS.map((kind): Drawable => ({
    id: `tool:${kind.kind}`,
    name: i18next.t(`editor.kind.${kind.kind}`),
    about: i18next.t(`editor.about.${kind.kind}`),
    icon: vipoIcon(kind.icon),
    tool: kind.kind,
    words: toolWords(kind.kind, other),
    draw: (open, under) => drawAt(open, kind.kind, under),
  }));
  const functions = Object.entries(document.functions).map(([id, { name }]): Drawable => ({
    id: `function:${id}`,
    name,
    about: i18next.t("commands.quick.function"),
    icon: vipoIcon("fn"),
    words: [...wordsOfName(name), ...toolWords("call", other)],
    draw: (open, { at }) =>
      createStep(open.document, open.apply, { kind: "call", pos: at, params: { function: id, args: {} } }),
  }));
  return [...functions, ...kinds];
}

/** Its name in both languages and its synonyms. */
function toolWords(kind: string, other: Words): string[] {
  const keys = [`editor.kind.${kind}`, `editor.also.${kind}`];
  return keys.flatMap((key) => [...wordsOf(i18next.t(key)), ...wordsOf(other(key))]);
}

/** Where a step goes when nobody points at a place. */
export function nowhere(open: OpenProgram): Under {
  return { step: null, link: null, device: null, at: freeSpot(open) };
}
