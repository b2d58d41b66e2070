/** Commands about the program as a whole. */
import { Box, Library, MapPin, MessageSquarePlus, Play, Settings2, SlidersHorizontal } from "lucide-react";
import { mayComment } from "@/api/roles";
import { aboutFrom } from "../comments/about";
import { useComments, writeAbout } from "../comments/commentsUi";
import { useScreen } from "../state/screen";
import { select, useUi } from "../state/ui";
import { command, needsRight, type Command, type WhyNot } from "./command";

const PROGRAM = { group: "program" } as const;

const cannotRun: WhyNot = ({ canRun, diagnostics }) => {
  if (!canRun) return "commands.why.no_running";
  return diagnostics.some((each) => each.severity === "error") ? "editor.run_blocked" : null;
};

export const PROGRAM_COMMANDS: readonly Command[] = [
  command({
    id: "run",
    ...PROGRAM,
    icon: Play,
    keys: ["Ctrl+Enter"],
    whyNot: cannotRun,
    run: () => useUi.setState({ dialog: "run" }),
  }),
  command({
    id: "simulate",
    ...PROGRAM,
    icon: Box,
    keys: ["Ctrl+Shift+Enter"],
    whyNot: ({ canRun }) => (canRun && useScreen.getState().simulate ? null : "commands.why.no_running"),
    run: () => useScreen.getState().simulate?.(),
  }),
  command({
    id: "simulate_with",
    ...PROGRAM,
    icon: SlidersHorizontal,
    whyNot: ({ canRun }) => (canRun ? null : "commands.why.no_running"),
    run: () => useUi.setState({ dialog: "rehearse" }),
  }),
  command({
    id: "comment_on",
    ...PROGRAM,
    icon: MessageSquarePlus,
    keys: ["Shift+C"],
    menus: ["step", "arrow", "floor"],
    whyNot: ({ site }) => (mayComment(site.role) ? null : "commands.why.no_comments"),
    run: (open, on) => writeAbout(aboutFrom(open, on)),
  }),
  command({
    id: "comment_pins",
    ...PROGRAM,
    icon: MapPin,
    run: () => useComments.setState(({ pins }) => ({ pins: !pins })),
  }),
  command({
    id: "library",
    ...PROGRAM,
    icon: Library,
    menus: ["floor"],
    whyNot: needsRight,
    run: () => useUi.setState({ dialog: "library" }),
  }),
  command({
    id: "program",
    ...PROGRAM,
    icon: Settings2,
    run: () => {
      select([]);
      useUi.setState({ inspector: true, programSheet: true });
    },
  }),
];
