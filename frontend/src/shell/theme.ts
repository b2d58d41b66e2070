/** Light, dark or as the system: the choice is kept in this browser (public/theme.js reads it before the first paint). */
import { create } from "zustand";

export type ThemeChoice = "light" | "dark" | "system";

const KEPT_AS = "vipo.theme";
const system = matchMedia("(prefers-color-scheme: dark)");

function keptChoice(): ThemeChoice {
  const kept = localStorage.getItem(KEPT_AS);
  return kept === "light" || kept === "dark" ? kept : "system";
}

const useChoice = create<{ choice: ThemeChoice; systemDark: boolean }>(() => ({
  choice: keptChoice(),
  systemDark: system.matches,
}));
// It is asked here alone: Chromium tells of no change when somebody has asked before it has drawn the page anew.
system.addEventListener("change", () => useChoice.setState({ systemDark: system.matches }));

export function chooseTheme(choice: ThemeChoice): void {
  localStorage.setItem(KEPT_AS, choice);
  useChoice.setState({ choice });
}

export function useThemeChoice(): ThemeChoice {
  return useChoice((state) => state.choice);
}

/** The theme that is seen now. */
export function useTheme(): "light" | "dark" {
  const { choice, systemDark } = useChoice();
  return choice === "dark" || (choice === "system" && systemDark) ? "dark" : "light";
}
