/** The menu of a step, on the map and in the list: right click, long press, Shift+F10. */
import { Menu } from "@mantine/core";
import { useCallback, useEffect } from "react";
import { useOpenProgram, type OpenProgram } from "../state/context";
import { select, useUi } from "../state/ui";
import { COMMANDS } from "./commands";
import { useLongPress } from "./longPress";
import classes from "../canvas/gestures.module.css";
import { useGestures, type MenuItem } from "../state/gestures";

const MENU = "gestures-menu";

export function StepMenu() {
  const open = useOpenProgram();
  const menu = useGestures((ui) => ui.menu);
  useEffect(() => {
    const ask = (event: MouseEvent) => openOver(open, event);
    window.addEventListener("contextmenu", ask, { capture: true });
    return () => window.removeEventListener("contextmenu", ask, { capture: true });
  }, [open]);
  useLongPress(useCallback((press) => openOver(open, press), [open]));
  const close = () => useGestures.setState({ menu: null });
  if (!menu) return null;
  return (
    <Menu opened onClose={close} position="bottom-start" shadow="md" trapFocus returnFocus id={MENU}>
      <Menu.Target>
        <span className={classes.anchor} style={{ left: menu.at.x, top: menu.at.y }} />
      </Menu.Target>
      <Menu.Dropdown aria-label={menu.label}>
        {menu.items.map((item) => (
          <Menu.Item
            key={item.id}
            onClick={() => {
              close();
              item.run();
            }}
            rightSection={item.keys ? <kbd className={classes.keys}>{item.keys}</kbd> : null}
          >
            {item.label}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}

function openOver(open: OpenProgram, event: MouseEvent): void {
  const over = stepUnder(open, event.target);
  const { selected, dialog } = useUi.getState();
  const byKeyboard = event.target === document.body && selected.length > 0;
  if (dialog || (!over && !byKeyboard)) return;
  event.preventDefault();
  event.stopPropagation();
  if (over && !selected.includes(over.id)) select([over.id]);
  const steps = useUi.getState().selected;
  const box = over?.element.getBoundingClientRect();
  const pointed = event.clientX > 0 || event.clientY > 0;
  const at = pointed || !box ? { x: event.clientX, y: event.clientY } : { x: box.left + 24, y: box.bottom };
  useGestures.setState({ menu: { at, label: open.t("gesture.menu"), items: itemsFor(open, steps) } });
}

function stepUnder({ document }: OpenProgram, target: EventTarget | null): { id: string; element: Element } | null {
  const element = target instanceof Element ? target.closest("[data-step], .react-flow__node[data-id]") : null;
  const id = element?.getAttribute("data-step") ?? element?.getAttribute("data-id") ?? "";
  return element && Object.hasOwn(document.steps, id) ? { id, element } : null;
}

export function itemsFor(open: OpenProgram, steps: readonly string[]): MenuItem[] {
  return COMMANDS.filter((command) => command.applies(open, steps)).map((command) => ({
    id: command.id,
    label: open.t(`gesture.command.${command.id}`),
    keys: command.keys.replace("Arrow", ""),
    run: () => command.run(open, steps),
  }));
}
