/** Bringing a device in: a key for one, an enrolment key for many, and a look at a description before it is sent. */
import { Button, Modal, Tabs } from "@mantine/core";
import { Plus } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Site } from "@/api/types";
import { CheckDescription } from "./CheckDescription";
import { ManyDevices } from "./ManyDevices";
import { OneDevice } from "./OneDevice";
import styles from "./enrolment.module.css";

export function AddDevice({ site }: { site: Site }) {
  const { t } = useTranslation();
  const [opened, setOpened] = useState(false);
  const close = () => setOpened(false);
  if (site.role !== "admin") return null;
  return (
    <>
      <Button leftSection={<Plus size={16} aria-hidden="true" />} onClick={() => setOpened(true)}>
        {t("adding.add")}
      </Button>
      <Modal opened={opened} onClose={close} closeOnClickOutside={false} title={t("adding.title")} size={680}>
        <Tabs defaultValue="one">
          <Tabs.List>
            {["one", "many", "check"].map((tab) => (
              <Tabs.Tab key={tab} value={tab}>
                {t(`adding.tab.${tab}`)}
              </Tabs.Tab>
            ))}
          </Tabs.List>
          <Tabs.Panel value="one" className={styles.panel}>
            <OneDevice site={site} close={close} />
          </Tabs.Panel>
          <Tabs.Panel value="many" className={styles.panel}>
            <ManyDevices site={site} />
          </Tabs.Panel>
          <Tabs.Panel value="check" className={styles.panel}>
            <CheckDescription site={site} />
          </Tabs.Panel>
        </Tabs>
      </Modal>
    </>
  );
}
