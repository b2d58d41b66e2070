/** A rehearsal for others: a link to the moment that is shown, and the recording as a file. */
import { Button, Menu, Popover, TextInput } from "@mantine/core";
import { Braces, Check, Copy, Download, FileChartLine, Film, Link2 } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { clock } from "@/design/clock";
import { addressOf } from "./address";
import styles from "./SimulationScreen.module.css";

interface SharingProps {
  program: string;
  rehearsal: string;
  t_s: number;
  onFilm: () => void;
}

export function Sharing(props: SharingProps) {
  return (
    <span className={styles.sharing}>
      <ShareLink {...props} />
      <Export {...props} />
    </span>
  );
}

function ShareLink({ program, rehearsal, t_s }: SharingProps) {
  const { t } = useTranslation();
  const [copied, setCopied] = useState("");
  const address = addressOf(program, rehearsal, t_s);
  const copy = async () => {
    await navigator.clipboard.writeText(address);
    setCopied(address);
  };
  return (
    <Popover width={360} position="top-end" trapFocus returnFocus withArrow>
      <Popover.Target>
        <Button size="xs" variant="default" leftSection={<Link2 size={15} aria-hidden="true" />}>
          {t("simulation.share.title")}
        </Button>
      </Popover.Target>
      <Popover.Dropdown aria-label={t("simulation.share.title")}>
        <div className={styles.share}>
          <TextInput
            label={t("simulation.share.link", { time: clock(t_s) })}
            description={t("simulation.share.who")}
            inputWrapperOrder={["label", "input", "description"]}
            value={address}
            readOnly
            onFocus={(event) => event.currentTarget.select()}
          />
          <Button
            size="xs"
            data-autofocus
            leftSection={
              copied === address ? <Check size={15} aria-hidden="true" /> : <Copy size={15} aria-hidden="true" />
            }
            onClick={() => void copy().catch(() => setCopied(""))}
          >
            <span role="status">{t(copied === address ? "simulation.share.copied" : "simulation.share.copy")}</span>
          </Button>
        </div>
      </Popover.Dropdown>
    </Popover>
  );
}

function Export({ rehearsal, onFilm }: SharingProps) {
  const { t } = useTranslation();
  const file = (form: string) => `/api/rehearsals/${rehearsal}/recording?form=${form}`;
  return (
    <Menu position="top-end" width={320}>
      <Menu.Target>
        <Button size="xs" variant="default" leftSection={<Download size={15} aria-hidden="true" />}>
          {t("simulation.export.title")}
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        <Menu.Item component="a" href={file("json")} download leftSection={<Braces size={16} aria-hidden="true" />}>
          {t("simulation.export.json")}
          <small className={styles.formAbout}>{t("simulation.export.json_about")}</small>
        </Menu.Item>
        <Menu.Item
          component="a"
          href={file("mcap")}
          download
          leftSection={<FileChartLine size={16} aria-hidden="true" />}
        >
          {t("simulation.export.mcap")}
          <small className={styles.formAbout}>{t("simulation.export.mcap_about")}</small>
        </Menu.Item>
        <Menu.Item leftSection={<Film size={16} aria-hidden="true" />} onClick={onFilm}>
          {t("simulation.export.webm")}
          <small className={styles.formAbout}>{t("simulation.export.webm_about")}</small>
        </Menu.Item>
      </Menu.Dropdown>
    </Menu>
  );
}
