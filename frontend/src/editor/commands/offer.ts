/** What the editor adds to the palette: its commands, steps, devices, places and people, and steps said in a sentence. */
import { Hand, MapPin, Cpu, UserRound } from "lucide-react";
import i18next from "i18next";
import { useMemo } from "react";
import { toPixels } from "@/map/plane/projection";
import { chipLabel } from "@/program/scene/announcements";
import { keysOf, useKeymap } from "@/shell/keys/keymap";
import { type Offer, useOffer } from "@/shell/palette/offers";
import { type Target, wordsOf } from "@/shell/palette/search";
import { createStep } from "../state/actions";
import { type OpenProgram, useOpenProgram } from "../state/context";
import { focusMap } from "../state/focus";
import { useGestures } from "../state/gestures";
import { useScreen } from "../state/screen";
import { select, showDevice } from "../state/ui";
import { selection, vipoIcon, type Command } from "./command";
import { type Drawable, drawablesAnywhere, drawablesOf, nowhere } from "./drawables";
import { runCommand } from "./keys";
import { fitting, type Named, partsOf, wordsOfName } from "./sentence";
import { COMMANDS } from "./table";
import { showSteps } from "./view";

type Words = (key: string) => string;

/** Offers it for as long as the editor is on the screen, as soon as this script has come. */
export function PaletteOffer() {
  const open = useOpenProgram();
  const offer = useMemo<Offer>(
    () => ({ targets: (other) => targetsOf(open, other), said: (query, other) => saidTargets(open, query, other) }),
    [open],
  );
  useOffer(offer);
  return null;
}

function targetsOf(open: OpenProgram, other: Words): Target[] {
  return [
    ...COMMANDS.filter((each) => !each.onlyKeys).map((each) => commandTarget(open, each, other)),
    ...stepTargets(open),
    ...deviceTargets(open),
    ...placeTargets(open),
    ...personTargets(open),
  ];
}

function commandTarget(open: OpenProgram, command: Command, other: Words): Target {
  const { name, about, also } = command.words;
  const reason = command.whyNot(open, selection());
  const known = [also ? i18next.t(also) : "", other(name), also ? other(also) : ""];
  return {
    id: `command:${command.id}`,
    kind: command.id.startsWith("tool_") ? "construct" : "command",
    name: i18next.t(name),
    also: known.join(" "),
    detail: about ? i18next.t(about) : undefined,
    icon: command.icon,
    keys: keysOf(command, useKeymap.getState())[0],
    whyNot: reason === null ? null : i18next.t(reason),
    // As its key would do it: what it asks for next is answered by typing.
    run: () => {
      focusMap();
      runCommand(open, command, { ...selection(), keys: "Enter" });
    },
  };
}

function stepTargets(open: OpenProgram): Target[] {
  return [...open.scene.chips.values()].map((chip) => ({
    id: `step:${chip.id}`,
    kind: "step",
    name: chipLabel(chip, open.speaker),
    icon: vipoIcon(chip.icon),
    run: () => {
      select([chip.id]);
      showSteps(open, [chip.id]);
    },
  }));
}

function deviceTargets({ devices, t }: OpenProgram): Target[] {
  return devices.map((device) => ({
    id: `here:device:${device.id}`,
    kind: "device",
    name: device.name,
    also: device.id,
    detail: t("device_here"),
    icon: Cpu,
    run: () => {
      showDevice(device.id);
      goTo([device.location.x, device.location.y]);
    },
  }));
}

function placeTargets({ plan, t }: OpenProgram): Target[] {
  return (plan?.places ?? []).map((place) => ({
    id: `here:place:${place.id}`,
    kind: "place",
    name: place.name,
    also: place.id,
    detail: t("place_here"),
    icon: MapPin,
    run: () => goTo([place.x, place.y]),
  }));
}

function personTargets({ people }: OpenProgram): Target[] {
  return people
    .filter((person) => !person.me)
    .map((person) => ({
      id: `person:${person.id}`,
      kind: "person",
      name: i18next.t("editor.gesture.follow.start", { name: person.name }),
      icon: UserRound,
      run: () => useGestures.setState({ following: person.client }),
    }));
}

function goTo(at: readonly [number, number]): void {
  const { stage } = useScreen.getState();
  const { x, y } = toPixels(at);
  if (stage) void stage.flow.setCenter(x, y, { zoom: Math.max(1, stage.flow.getZoom()) });
}

interface Spot extends Named {
  readonly name: string;
  readonly device: string | null;
  readonly at: readonly [number, number];
}

function spotsOf({ devices, plan }: OpenProgram): Spot[] {
  return [
    ...devices.map(({ id, name, location }) => ({
      id,
      name,
      device: id,
      at: [location.x, location.y] as const,
      words: [...wordsOf(name), ...wordsOfName(id)],
    })),
    ...(plan?.places ?? []).map(({ id, name, x, y }) => ({
      id,
      name,
      device: null,
      at: [x, y] as const,
      words: [...wordsOf(name), ...wordsOfName(id)],
    })),
  ];
}

const MOST_SAID = 4;

/** "add Paint at Oven": the step that it makes, or why it cannot be made there. */
export function saidTargets(open: OpenProgram, query: string, other: Words): Target[] {
  if (!open.canEdit) return [];
  const parts = partsOf(query);
  const spots = parts?.where ? fitting(parts.where, spotsOf(open)) : [];
  const [spot] = spots;
  if (!parts || (parts.where && !spot)) return [];
  const device = open.surroundings.devices.get(spot?.device ?? "");
  const own = device ? drawablesOf(device, other) : [];
  const anywhere = drawablesAnywhere(open, other).filter((each) => !device || !isAboutDevices(each));
  const fits = fitting(parts.what, [...own, ...anywhere]);
  if (fits.length > 0) return fits.slice(0, MOST_SAID).map((what) => saidTarget(open, what, spot ?? null));
  return device ? refusal(query, i18next.t("commands.quick.cannot", { device: device.name })) : [];
}

/** What is drawn by choosing a device can be drawn only at one that suits, which then has it in its own list. */
function isAboutDevices({ tool = "" }: Drawable): boolean {
  return ["pick", "drop", "pick_and_drop", "move", "operate"].includes(tool);
}

function refusal(query: string, whyNot: string): Target[] {
  return [{ id: "said:nothing", kind: "construct", name: query.trim(), icon: Hand, whyNot, run: () => undefined }];
}

function saidTarget(open: OpenProgram, what: Drawable, spot: Spot | null): Target {
  const words = { what: what.name, where: spot?.name ?? "" };
  return {
    id: `said:${what.id}:${spot?.id ?? ""}`,
    kind: "construct",
    name: spot ? i18next.t("commands.quick.at", words) : what.name,
    detail: what.about,
    icon: what.icon,
    run: () => {
      focusMap();
      if (spot && spot.device === null && what.tool === "move") moveTo(open, spot);
      else what.draw(open, spot ? { step: null, link: null, device: spot.device, at: spot.at } : nowhere(open));
    },
  };
}

/** To a place by its name, not to the point where it lies. */
function moveTo({ document, apply }: OpenProgram, { id, at }: Spot): void {
  createStep(document, apply, { kind: "move", pos: at, params: { role: "robot", to: { place: id } } });
}
