/** Light, dark or as the system: the choice is kept in this browser (public/theme.js reads it before the first paint). */
import { useSyncExternalStore } from "react";
import { create } from "zustand";

export type ThemeChoice = "light" | "dark" | "system";

const KEPT_AS = "vipo.theme";
const system = matchMedia("(prefers-color-scheme: dark)");

function keptChoice(): ThemeChoice {
  const kept = localStorage.getItem(KEPT_AS);
  return kept === "light" || kept === "dark" ? kept : "system";
}

const useChoice = create<{ choice: ThemeChoice }>(() => ({ choice: keptChoice() }));

export function chooseTheme(choice: ThemeChoice): void {
  localStorage.setItem(KEPT_AS, choice);
  useChoice.setState({ choice });
}

export function useThemeChoice(): ThemeChoice {
  return useChoice((state) => state.choice);
}

/** The theme that is seen now. */
export function useTheme(): "light" | "dark" {
  const choice = useThemeChoice();
  const systemDark = useSyncExternalStore(
    (changed) => {
      system.addEventListener("change", changed);
      return () => system.removeEventListener("change", changed);
    },
    () => system.matches,
  );
  return choice === "dark" || (choice === "system" && systemDark) ? "dark" : "light";
}
