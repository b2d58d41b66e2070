/** The items of an open menu. */
import { Menu } from "@mantine/core";
import { Fragment } from "react";
import { useTranslation } from "react-i18next";
import { wordsOfKeys } from "@/shell/keys/keyNames";
import { useOpenProgram } from "../state/context";
import { type MenuItem, type OpenMenu, useGestures } from "../state/gestures";
import classes from "../canvas/gestures.module.css";

export function MenuItems({ menu }: { menu: OpenMenu }) {
  const close = () => useGestures.setState({ menu: null });
  return (
    <Menu opened onClose={close} position="bottom-start" shadow="md" trapFocus returnFocus width={280}>
      <Menu.Target>
        <span className={classes.anchor} style={{ left: menu.at.x, top: menu.at.y }} />
      </Menu.Target>
      <Menu.Dropdown aria-label={menu.label}>
        {menu.items.map((item, index) => (
          <Fragment key={item.id}>
            {index > 0 && item.group !== menu.items[index - 1]?.group ? <Menu.Divider /> : null}
            <Item item={item} close={close} />
          </Fragment>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}

function Item({ item, close }: { item: MenuItem; close: () => void }) {
  const { t } = useTranslation();
  const open = useOpenProgram();
  const { icon: Icon, keys } = item;
  const run = () => {
    close();
    item.run(open);
  };
  return (
    <Menu.Item
      onClick={run}
      leftSection={Icon ? <Icon size={16} /> : undefined}
      rightSection={
        keys ? <kbd className={classes.keys}>{wordsOfKeys(keys, (key) => t(`shell.keys.${key}`, key))}</kbd> : null
      }
    >
      {item.label}
    </Menu.Item>
  );
}
