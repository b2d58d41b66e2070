import { expect, test } from "vitest";
import { gatherAreas } from "@/i18n/areas";
import { texts as germanFiles } from "@/i18n/catalogue.de";
import { texts as englishFiles } from "@/i18n/catalogue.en";
import { keysOf, PLAIN_KEYMAP } from "@/shell/keys/keymap";
import { isCharacterKey, nameOfKeys } from "@/shell/keys/keyNames";
import { SHELL_COMMANDS } from "@/shell/keys/shellCommands";
import { TOOLS } from "../state/tools";
import { isTypable, takenBy } from "./bindings";
import { GROUPS, SITUATIONS } from "./command";
import { toolId } from "./drawing";
import { commandOfKeys } from "./keys";
import { COMMANDS, commandOf } from "./table";

const [german, english] = [gatherAreas(germanFiles), gatherAreas(englishFiles)];

function textAt(texts: object, key: string): unknown {
  return key.split(".").reduce<unknown>((part, name) => (part as Record<string, unknown> | undefined)?.[name], texts);
}

test("every command has a name and other words for it in both languages", () => {
  const wordless = COMMANDS.flatMap(({ id, words }) =>
    Object.values(words)
      .filter((key) => [english, german].some((texts) => typeof textAt(texts, key) !== "string"))
      .map((key) => [id, key]),
  );
  expect(wordless).toEqual([]);
  expect(COMMANDS.length).toBeGreaterThan(70);
});

test("ids are given once, and groups and situations are known", () => {
  expect(new Set(COMMANDS.map(({ id }) => id)).size).toBe(COMMANDS.length);
  expect(COMMANDS.filter(({ group, when }) => !GROUPS.includes(group) || !SITUATIONS.includes(when))).toEqual([]);
});

test("every construct is a command", () => {
  expect(TOOLS.map(({ kind }) => commandOf(toolId(kind)).id)).toEqual(TOOLS.map(({ kind }) => `tool_${kind}`));
});

test("no two commands share a key in the same situation, and none has a key that every page hears", () => {
  const having = COMMANDS.flatMap(({ id, keys, when }) => keys.map((key) => ({ id, spot: `${when} ${key}`, key })));
  const twice = having.filter(({ id, spot }) => having.some((other) => other.spot === spot && other.id !== id));
  expect(twice).toEqual([]);
  const everywhere = SHELL_COMMANDS.flatMap(({ keys }) => keys);
  expect(having.filter(({ key }) => everywhere.includes(key))).toEqual([]);
});

test("each key is bound: pressed where its command is meant, it means that command", () => {
  const unbound = COMMANDS.flatMap((command) =>
    command.keys.filter((keys) => commandOfKeys(keys, PLAIN_KEYMAP, (now) => now === command.when) !== command),
  );
  expect(unbound).toEqual([]);
});

test("the narrowest situation has the key", () => {
  expect(commandOfKeys("Enter", PLAIN_KEYMAP, () => true)?.id).toBe("zone_close");
  expect(commandOfKeys("Enter", PLAIN_KEYMAP, (now) => now === "map")?.id).toBe("enter");
  expect(commandOfKeys("Delete", PLAIN_KEYMAP, (now) => now === "zone" || now === "map")?.id).toBe("delete_zone");
  // With Ctrl it says what is missing; a letter that means nothing here is nobody's.
  expect(commandOfKeys("Ctrl+G", PLAIN_KEYMAP, (now) => now === "map")?.id).toBe("make_function");
  expect(commandOfKeys("Delete", PLAIN_KEYMAP, (now) => now === "map")).toBeUndefined();
});

test("without single characters no letter means a command, and a person's own keys take the place of others", () => {
  const quiet = { own: {}, characters: false };
  expect(COMMANDS.flatMap((each) => keysOf(each, quiet)).filter(isCharacterKey)).toEqual([]);
  expect(commandOfKeys("M", quiet, () => true)).toBeUndefined();
  const own = { own: { tool_move: ["Ctrl+M"] }, characters: false };
  expect(commandOfKeys("Ctrl+M", own, (now) => now === "map")?.id).toBe("tool_move");
});

test("a key that another command has there is refused, and so is one of the browser's or one that not all can type", () => {
  expect(takenBy(commandOf("tidy"), "Ctrl+G", PLAIN_KEYMAP)?.id).toBe("make_function");
  expect(takenBy(commandOf("tidy"), "Ctrl+K", PLAIN_KEYMAP)?.id).toBe("palette");
  expect(takenBy(commandOf("tidy"), "Shift+T", PLAIN_KEYMAP)).toBeNull();
  expect(["Shift+T", "Ctrl+Shift+U", "F9", "/"].filter(isTypable)).toEqual(["Shift+T", "Ctrl+Shift+U", "F9", "/"]);
  expect(["Ctrl+W", "Tab", "Ctrl+/", "[", "Ä", "F5"].filter(isTypable)).toEqual([]);
});

/** What a keyboard writes with its plain keys, with Shift and with AltGr (Option has none of ours). */
interface Layout {
  readonly plain: string;
  readonly shifted: string;
  readonly third: string;
}

const LETTERS = "abcdefghijklmnopqrstuvwxyz";
const LAYOUTS: Readonly<Record<string, Layout>> = {
  us: {
    plain: `\`1234567890-=[]\\;',./${LETTERS}`,
    shifted: `~!@#$%^&*()_+{}|:"<>?${LETTERS.toUpperCase()}`,
    third: "",
  },
  de: {
    plain: `^1234567890ß´ü+öä#,.-<${LETTERS}`,
    shifted: `°!"§$%&/()=?\`Ü*ÖÄ';:_>${LETTERS.toUpperCase()}`,
    third: "²³{[]}\\@€~|µ",
  },
  fr: {
    plain: `²&é"'(-è_çà)=^$ù*,;:!<${LETTERS}`,
    shifted: `1234567890°+¨£%µ?./§>${LETTERS.toUpperCase()}`,
    third: "~#{[|`\\^@]}€¤",
  },
};

/** The event of a keyboard on which the keys are pressed; null where it cannot write the character so. */
function typedOn(layout: Layout, keys: string): string | null {
  const held = /^(Ctrl\+)?(Alt\+)?(Shift\+)?/.exec(keys)?.[0] ?? "";
  const last = keys.slice(held.length);
  const event = {
    ctrlKey: held.includes("Ctrl"),
    altKey: held.includes("Alt"),
    metaKey: false,
    shiftKey: held.includes("Shift"),
  };
  if (last.length > 1) return nameOfKeys({ ...event, key: last });
  const letter = LETTERS.includes(last.toLowerCase());
  if (letter) return nameOfKeys({ ...event, key: event.shiftKey ? last : last.toLowerCase() });
  if (layout.plain.includes(last)) return nameOfKeys({ ...event, key: last });
  // Ctrl with a character for which Shift is held is another shortcut on some systems: nobody finds it.
  if (layout.shifted.includes(last) && !event.ctrlKey) return nameOfKeys({ ...event, key: last, shiftKey: true });
  return null;
}

test.each(Object.keys(LAYOUTS))("every command can be typed on a keyboard: %s", (name) => {
  const layout = LAYOUTS[name] as Layout;
  const keys = COMMANDS.flatMap((command) => command.keys);
  expect(keys.filter((each) => typedOn(layout, each) !== each)).toEqual([]);
});

test("the layouts notice what cannot be typed: Ctrl+/ on a German keyboard", () => {
  expect(typedOn(LAYOUTS.us as Layout, "Ctrl+/")).toBe("Ctrl+/");
  expect(typedOn(LAYOUTS.de as Layout, "Ctrl+/")).toBeNull();
  expect(typedOn(LAYOUTS.fr as Layout, "Ctrl+/")).toBeNull();
  expect(typedOn(LAYOUTS.de as Layout, "/")).toBe("/");
  expect(typedOn(LAYOUTS.de as Layout, "[")).toBeNull();
});
