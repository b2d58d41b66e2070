/** Opens a zone, into which robots are let one by one, to all of them for a time. */
import { Button, Menu } from "@mantine/core";
import { LockOpen } from "lucide-react";
import { useEffect } from "react";
import { useTranslation } from "react-i18next";
import { useChangeZone } from "@/api/zones";
import { formatTime } from "@/i18n/format";
import { tellRefusal } from "../refusal";
import styles from "./admissions.module.css";

const MINUTES = [15, 60, 240, 480] as const;

interface OpenZoneMenuProps {
  slug: string;
  zone: string;
  name: string;
  /** Whether it is open already, so that the time is another from then on. */
  isOpen?: boolean;
  /** Told when the menu opens and when it is gone, for a list that must not close at a press on it. */
  onMenu?: (open: boolean) => void;
}

export function OpenZoneMenu({ slug, zone, name, isOpen = false, onMenu }: OpenZoneMenuProps) {
  const { t } = useTranslation();
  const change = useChangeZone(slug, (error) => tellRefusal(error, t));
  const words = t(isOpen ? "admission.opening.again" : "admission.opening.menu");
  const open = (minutes: number) => change.mutate({ do: "open", id: zone, minutes });
  useEffect(() => () => onMenu?.(false), [onMenu]);
  return (
    <Menu shadow="md" position="bottom-start" onChange={onMenu}>
      <Menu.Target>
        <Button
          variant="default"
          size="compact-md"
          loading={change.isPending}
          leftSection={<LockOpen size={14} aria-hidden="true" />}
          aria-label={t("admission.opening.of", { words, zone: name })}
        >
          {words}
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        {MINUTES.map((minutes) => (
          <Menu.Item
            key={minutes}
            onClick={() => open(minutes)}
            rightSection={<span className={styles.until}>{formatTime(inSo(minutes))}</span>}
          >
            {t(`admission.opening.for_${minutes}`)}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}

function inSo(minutes: number): string {
  return new Date(Date.now() + minutes * 60_000).toISOString();
}
