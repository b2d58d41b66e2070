import { Button, Modal, TextInput } from "@mantine/core";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import type { Device, Site } from "@/api/types";
import { useReturnFocus } from "@/design/useReturnFocus";
import { useDecide } from "./decisions";
import styles from "./detail.module.css";

export function RenameDevice({ site, device, onClose }: { site: Site; device: Device; onClose: () => void }) {
  const { t } = useTranslation();
  useReturnFocus();
  const [name, setName] = useState(device.name);
  const decide = useDecide(site.slug);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    decide.mutate({ do: "rename", device, name: name.trim() }, { onSuccess: onClose });
  };
  return (
    <Modal opened onClose={onClose} title={t("pages.devices.rename")} size={400}>
      <form onSubmit={submit} className={styles.form}>
        <TextInput
          data-autofocus
          label={t("pages.devices.name")}
          maxLength={100}
          value={name}
          onChange={(event) => setName(event.target.value)}
        />
        <Button type="submit" disabled={!name.trim()} loading={decide.isPending}>
          {t("pages.devices.rename")}
        </Button>
      </form>
    </Modal>
  );
}
