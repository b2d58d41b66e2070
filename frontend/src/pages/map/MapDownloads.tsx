/** A map's two ROS files in a menu; `fileOf` says where each is. */
import { Button, Menu } from "@mantine/core";
import { Download } from "lucide-react";
import { useTranslation } from "react-i18next";
import styles from "./MapPage.module.css";

export type MapForm = "yaml" | "pgm";

export function MapDownloads({ fileOf }: { fileOf: (form: MapForm) => string }) {
  const { t } = useTranslation();
  return (
    <Menu position="bottom-end">
      <Menu.Target>
        <Button
          variant="default"
          classNames={{ label: styles.actionLabel ?? "", section: styles.actionIcon ?? "" }}
          leftSection={<Download size={16} aria-hidden="true" />}
        >
          {t("pages.map.download.title")}
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        {(["yaml", "pgm"] as const).map((form) => (
          <Menu.Item key={form} component="a" href={fileOf(form)} download>
            {t(`pages.map.download.${form}`)}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}
