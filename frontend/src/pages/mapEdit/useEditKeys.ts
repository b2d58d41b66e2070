/** The keys of the map editor: a tool's letter, undo and redo. */
import { useEffect } from "react";
import { TOOLS, type ToolName } from "./tools";

interface Keys {
  choose: (tool: ToolName) => void;
  undo: () => void;
  redo: () => void;
  isOff: boolean;
}

export function useEditKeys({ choose, undo, redo, isOff }: Keys): void {
  useEffect(() => {
    if (isOff) return;
    const press = (event: KeyboardEvent) => {
      const isTyping = event.target instanceof HTMLInputElement;
      if (isTyping || event.altKey) return;
      const key = event.key.toLowerCase();
      if (event.ctrlKey || event.metaKey) {
        const act = key === "z" ? (event.shiftKey ? redo : undo) : key === "y" ? redo : null;
        if (!act) return;
        event.preventDefault();
        act();
        return;
      }
      const tool = TOOLS.find((each) => each.key === key);
      if (tool) choose(tool.name);
    };
    window.addEventListener("keydown", press);
    return () => window.removeEventListener("keydown", press);
  }, [choose, undo, redo, isOff]);
}
